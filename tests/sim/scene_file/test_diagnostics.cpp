#include "sim/scene_file/diagnostics.hpp"

#include <catch2/catch.hpp>

using namespace unravel;
using namespace unravel::sim;

TEST_CASE("all problems of a scene are shown together, with line, caret and hint", "[scene]") {
    const std::string text =
        "# a broken scene\n"
        "[clip]\n"
        "size = [8, 720]\n"
        "fps = 25\n"
        "\n"
        "[cloth]\n"
        "name = \"été\"\n"
        "\tdensity = nan\n"
        "\n"
        "[[solid]]\n"
        "shape = \"sphere\"\n"
        "radus = 0.3\n";
    std::string shown;
    try {
        parse_scene(text, "scenes/broken.toml", {},
                    {"solver.step=0.006", "cloth.pin={box=[0.01,0,0.012,1]}"});
    } catch (const SceneError& error) {
        shown = error.what();
    }
    CHECK(
        shown ==
        "scenes/broken.toml:3:9: error: 'size' is 8; it must be from 16 to 8192\n"
        "    3 | size = [8, 720]\n"
        "      |         ^\n"
        "scenes/broken.toml:8:12: error: 'density' is nan, not a number; it must be from 0.0001 to 1000 "
        "kg/m²\n"
        "    8 |  density = nan\n"
        "      |            ^~~\n"
        "scenes/broken.toml:12:1: error: unknown key 'radus'; did you mean 'radius'?\n"
        "   12 | radus = 0.3\n"
        "      | ^~~~~\n"
        "--set #1 (solver.step=0.006): error: the step of 0.006 s does not divide a frame of 1/25 s; the "
        "nearest "
        "that does is \"1/175\"\n"
        "      | solver.step=0.006\n"
        "      |             ^~~~~\n"
        "--set #2 (cloth.pin={box=[0.01,0,0.012,1]}): error: the pin catches no particle; the nearest is at "
        "u = 0.02, v = 0.5\n"
        "      | cloth.pin={box=[0.01,0,0.012,1]}\n"
        "      |                ^\n"
        "5 problems in the scene");
}

TEST_CASE("the caret stands under its character in long and in accented lines", "[scene]") {
    const auto shown = [](const std::string& line, int column) {
        const std::string all = format_problems({{{1, column, 0}, "bad", ""}}, {"f", line, {}, {}});
        return all.substr(all.find('\n') + 1);
    };
    CHECK(shown("a = \"éé\" !", 10) == "    1 | a = \"éé\" !\n      |          ^\n1 problem in the scene");
    CHECK(shown("ab", 99) == "    1 | ab\n      |   ^\n1 problem in the scene");
    const std::string text = shown(std::string(500, '.') + "!" + std::string(500, '.'), 501);
    const std::size_t first = text.find('\n'), second = text.find('\n', first + 1);
    CHECK(first < 130);
    CHECK(text.find('!') == text.find('^') - first - 1);
    CHECK(second > first);
}

TEST_CASE("thousands of problems do not flood the terminal", "[scene]") {
    const std::vector<SceneProblem> many(5000, {{1, 1, 0}, "bad", ""});
    const std::string shown = format_problems(many, {"f", "x", {}, {}});
    CHECK(shown.size() < 10000);
    CHECK_THAT(shown, Catch::Contains("and 4950 more problems"));
}

TEST_CASE("places fall back to the table around and know what is sound", "[scene]") {
    Places places;
    places.add("cloth[0]", {3, 1, 0});
    places.add("cloth[0].size", {4, 8, 0});
    places.mark_bad("cloth[0].pin[1].box");
    CHECK(places.at("cloth[0].size").line == 4);
    CHECK(places.at("cloth[0].density").line == 3);
    CHECK(places.at("solver.step").line == 1);
    CHECK(places.sound("cloth[0].size"));
    CHECK(places.sound_itself("cloth[0]"));
    CHECK(!places.sound("cloth[0]"));
    CHECK(!places.sound("cloth[0].pin"));
    CHECK(!places.sound("cloth[0].pin[1].box"));
    CHECK(places.sound("cloth[0].pin[1].boxes"));
    CHECK(places.sound("clot"));
    places.mark_bad("cloth[0].sizes");
    CHECK(places.sound("cloth[0].size"));
    CHECK(!places.sound_itself("cloth[0]"));
}
