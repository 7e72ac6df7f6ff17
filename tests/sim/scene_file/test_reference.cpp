#include "sim/scene_file/reference.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

#include "sim/scene_file/presets.hpp"
#include "sim/scene_file/schema.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

std::string read(const char* path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

const std::string page = read(UNRAVEL_SOURCE_DIR "/docs/scenes.md");

}  // namespace

TEST_CASE("docs/scenes.md tells of no key that the reader does not know", "[scene]") {
    const std::size_t begin = page.find("## Every table and key");
    REQUIRE(begin != page.npos);
    const std::map<std::string, std::vector<std::string>> known = tables_of_keys();
    int rows = 0;
    for (std::size_t at = page.find("\n| `", begin); at != page.npos; at = page.find("\n| `", at + 1)) {
        const std::string key = page.substr(at + 4, page.find('`', at + 4) - at - 4);
        INFO(key);
        CHECK(known.contains(key));
        ++rows;
    }
    CHECK(rows > 80);
}

TEST_CASE("the reference has every key that the reader knows", "[scene]") {
    const std::string reference = scene_reference();
    for (const auto& [key, tables] : tables_of_keys()) {
        INFO(key);
        CHECK(reference.find("| `" + key + "` |") != reference.npos);
    }
}

TEST_CASE("docs/scenes.md lists every preset", "[scene]") {
    for (const std::string_view name : preset_names()) {
        INFO(name);
        CHECK(page.find("| `" + std::string(name) + "` |") != page.npos);
    }
}
