#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "sim/run/stats.hpp"
#include "source_dir.hpp"
#include "tests/base/temporary_folder.hpp"
#include "tests/json_schema.hpp"
#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/inspect/inspected.hpp"
#include "tool/report/page_files.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// A short run without pictures.
RunFolder short_run(const TemporaryFolder& folder) {
    const std::filesystem::path run = folder / "run";
    REQUIRE(run_command_line({"simulate", UNRAVEL_SOURCE_DIR "/scenes/drape_sphere.toml", "--set",
                              "cloth.particles=[11,11]", "--set", "clip.duration=0.2", "-o", run.string(),
                              "--compare-whole", "--quiet", "--threads", "1"}) == exit_done);
    return {run};
}

}  // namespace

TEST_CASE("run.json is as its schema says, and the schema is strict", "[tool]") {
    const TemporaryFolder folder;
    const RunFolder made = short_run(folder);
    const auto schema = nlohmann::json::parse(page_file("run.schema.json"));
    const auto run = nlohmann::json::parse(text_of(made.run_json()));
    CHECK(valid(run, schema));
    for (const char* key : {"status", "effects", "totals", "frames"}) {
        nlohmann::json without = run;
        without.erase(key);
        CAPTURE(key);
        CHECK_FALSE(valid(without, schema));
    }
    nlohmann::json odd = run;
    odd["status"] = "fine";
    CHECK_FALSE(valid(odd, schema));
    odd = run;
    odd["something_new"] = 1;
    CHECK_FALSE(valid(odd, schema));
}

TEST_CASE("stats.csv has the documented columns and a row per step", "[tool]") {
    const TemporaryFolder folder;
    const RunFolder made = short_run(folder);
    const std::string csv = text_of(made.stats());
    std::string header;
    for (const StatsColumn& column : stats_columns()) {
        header += (header.empty() ? "" : ",") + std::string(column.name);
        CHECK(std::string(column.meaning).size() > 3);
    }
    CHECK(csv.substr(0, csv.find('\n')) == header);
    const auto run = nlohmann::json::parse(text_of(made.run_json()));
    CHECK(std::count(csv.begin(), csv.end(), '\n') == run["steps"].get<int>() + 1);
}

TEST_CASE("a run without pictures has a page that says so and fetches nothing", "[tool]") {
    const TemporaryFolder folder;
    const RunFolder made = short_run(folder);
    const std::string page = text_of(made.report());
    CHECK(page.find("{{data}}") == std::string::npos);
    CHECK(page.find("\"views\":[]") != std::string::npos);
    CHECK(page.find("\"rvm_whole\"") != std::string::npos);
    CHECK(page.find("src=\"http") == std::string::npos);
}

TEST_CASE("inspecting the last step of a frame finds the very state that the run had", "[tool]") {
    const TemporaryFolder folder;
    const RunFolder made = short_run(folder);
    const CachedRun run = open_cached_run(made.root);
    const auto json = nlohmann::json::parse(text_of(made.run_json()));
    const InspectedStep step = inspect_step(run, 3, 0);
    CHECK(fmt::format("{:016x}", state_hash(step.record.state)) ==
          json["state_hashes"][3].get<std::string>());
    CHECK(step.components.size() == step.report.components);
    const InspectedStep earlier = inspect_step(run, 3, 1);
    CHECK(earlier.report.step == step.report.step - static_cast<std::uint64_t>(step.steps) + 1);
    CHECK_THROWS_AS(inspect_step(run, 0, 0), UsageError);
    CHECK_THROWS_AS(inspect_step(run, 99, 0), FolderError);
    CHECK_THROWS_AS(inspect_step(run, 3, step.steps + 1), UsageError);
}
