// The corpus of broken scenes: each file names what has to be found in it, in lines
//   # expect: line:column beginning of "what; hint"
// and nothing else may be reported.

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sim/scene_file/load.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

struct Expected {
    int line = 0, column = 0;
    std::string text;
};

std::vector<Expected> expectations(const std::string& scene) {
    std::vector<Expected> out;
    std::istringstream lines(scene);
    const std::string mark = "# expect: ";
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(mark)) continue;
        std::istringstream words(line.substr(mark.size()));
        Expected expected;
        char colon = 0, blank = 0;
        words >> expected.line >> colon >> expected.column;
        words.get(blank);
        std::getline(words, expected.text);
        out.push_back(expected);
    }
    return out;
}

std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("each broken scene is refused with all of its problems and no other", "[scene]") {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(UNRAVEL_SOURCE_DIR "/tests/scenes_bad")) {
        if (entry.path().extension() != ".toml") continue;
        ++files;
        INFO(entry.path().filename());
        std::vector<Expected> expected = expectations(read(entry.path()));
        REQUIRE(!expected.empty());
        std::vector<SceneProblem> found;
        try {
            load_scene(entry.path());
        } catch (const SceneError& error) {
            found = error.problems();
        }
        for (const SceneProblem& problem : found) {
            const std::string text = problem.hint.empty() ? problem.what : problem.what + "; " + problem.hint;
            INFO(problem.place.line << ":" << problem.place.column << " " << text);
            const auto match = std::find_if(expected.begin(), expected.end(), [&](const Expected& one) {
                return one.line == problem.place.line && one.column == problem.place.column &&
                       text.starts_with(one.text);
            });
            CHECK(match != expected.end());
            if (match != expected.end()) expected.erase(match);
        }
        for (const Expected& missed : expected)
            FAIL_CHECK("not reported: " << missed.line << ":" << missed.column << " " << missed.text);
    }
    CHECK(files > 30);
}
