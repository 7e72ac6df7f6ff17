// Every case of scenes/hard/cases.toml does what the list says it must: survives within its bounds, or is
// refused or stopped with the cause named. Long ones are ended early; `unravel stability` runs them whole.

#include <catch2/catch.hpp>
#include <set>

#include "source_dir.hpp"
#include "tool/study/stability/hard_case.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

const std::filesystem::path list = std::filesystem::path(UNRAVEL_SOURCE_DIR) / "scenes/hard/cases.toml";

}  // namespace

TEST_CASE("every hard case does what it must", "[hard]") {
    for (const HardCase& hard : read_hard_cases(list)) {
        DYNAMIC_SECTION(hard.name) {
            const HardOutcome outcome = run_hard_case(hard, hard.frames);
            for (const std::string& failure : outcome.failures) UNSCOPED_INFO(failure);
            CHECK(outcome.failures.empty());
        }
    }
}

TEST_CASE("hard cases have names of their own and scenes that are used") {
    std::set<std::string> names;
    std::set<std::filesystem::path> used;
    for (const HardCase& hard : read_hard_cases(list)) {
        CHECK(names.insert(hard.name).second);
        used.insert(hard.scene.filename());
    }
    for (const auto& entry : std::filesystem::directory_iterator(list.parent_path())) {
        if (entry.path().filename() == "cases.toml") continue;
        INFO(entry.path());
        CHECK(used.count(entry.path().filename()) == 1);
    }
}

TEST_CASE("a hard case that breaks its bounds is told so") {
    HardCase hard;
    hard.name = "hang";
    hard.scene = list.parent_path() / "hang.toml";
    hard.set = {"cloth.material.stretch=1"};
    hard.strain = 1e-6;
    const HardOutcome outcome = run_hard_case(hard, 3);
    REQUIRE(outcome.failures.size() == 1);
    CHECK(outcome.failures.front().find("strain") != std::string::npos);
    hard.must = Must::refuse;
    hard.says = "anything";
    CHECK(run_hard_case(hard, 3).failures.size() == 1);
}
