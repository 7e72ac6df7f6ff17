// Rows of solids and cloths, hooks along an edge, included files, and what rides on what.

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>

#include "sim/mesh/placement.hpp"
#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

std::vector<SceneProblem> problems_of(const std::string& text) {
    try {
        parse_scene(text, "a.toml");
    } catch (const SceneError& error) {
        return error.problems();
    }
    return {};
}

class Folder {
public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "unravel_includeXXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name) << text;
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

}  // namespace

TEST_CASE("a row of solids stands as it is spaced, each by its own name, and is written out", "[scene]") {
    const Scene scene = parse_scene(
        "[cloth]\ncenter = [0, 5, 0]\n[[solid]]\nname = \"post\"\nshape = \"cylinder\"\ncenter = [1, 0, "
        "0]\ncount = 3\n"
        "spacing = [0, 0, 0.5]\nmirror = \"x\"\n[[solid]]\nshape = \"sphere\"\n",
        "a.toml");
    REQUIRE(scene.solids.size() == 7);
    const std::map<std::string, Vec3> expected{
        {"post", {1, 0, 0}},           {"post 2", {1, 0, 0.5}},           {"post 3", {1, 0, 1}},
        {"post mirrored", {-1, 0, 0}}, {"post 2 mirrored", {-1, 0, 0.5}}, {"post 3 mirrored", {-1, 0, 1}},
        {"sphere", {0, 0, 0}}};
    for (const Solid& solid : scene.solids) {
        INFO(solid.name);
        CHECK(solid.center == expected.at(solid.name));
        CHECK(solid.pivot == solid.center);
    }
    CHECK(parse_scene(scene_to_toml(scene), "a.toml").solids.size() == 7);
}

TEST_CASE("what is wrong with a thing that is repeated is told where it is written", "[scene]") {
    // The third of the row holds the cloth.
    const std::vector<SceneProblem> found = problems_of(
        "[cloth]\ncenter = [2, 0, 0]\n[[solid]]\nshape = \"sphere\"\nradius = 0.2\ncenter = [0, 0, 0]\ncount "
        "= 3\n"
        "spacing = [1, 0, 0]\n");
    REQUIRE(!found.empty());
    CHECK(found[0].place.line == 3);
    CHECK(found[0].what.find("holds the cloth at the start") != std::string::npos);
    const std::vector<SceneProblem> stacked = problems_of("[cloth]\ncount = 2\n");
    REQUIRE(stacked.size() == 1);
    CHECK(stacked[0].place.line == 2);
    CHECK(stacked[0].what == "2 of them in one place");
}

TEST_CASE("a cloth's copies keep its look", "[scene]") {
    const Scene scene = parse_scene(
        "[[cloth]]\nmirror = \"x\"\ncenter = [3, 0, 0]\n[[cloth]]\ncenter = [0, 0, 3]\n"
        "[[look.cloth]]\nfront = \"#000001\"\n[[look.cloth]]\nfront = \"#000002\"\n",
        "a.toml");
    REQUIRE(scene.look.cloth.size() == 3);
    CHECK(scene.look.cloth[2].front == "#000001");
}

TEST_CASE("hooks are spaced evenly along an edge, from end to end", "[scene]") {
    for (const auto& [particles, count] : {std::pair{61, 7}, {50, 8}, {9, 9}, {20, 2}, {21, 1}}) {
        std::vector<int> hooks;
        for (int i = 0; i < particles; ++i)
            if (evenly_chosen(i, particles, count, false)) hooks.push_back(i);
        REQUIRE(hooks.size() == static_cast<std::size_t>(count));
        if (count == 1) {
            CHECK(hooks[0] == 10);
            continue;
        }
        CHECK(hooks.front() == 0);
        CHECK(hooks.back() == particles - 1);
        const double gap = static_cast<double>(particles - 1) / (count - 1);
        for (std::size_t k = 0; k < hooks.size(); ++k)
            CHECK(std::abs(hooks[k] - gap * static_cast<double>(k)) <= 0.5);
    }
    int around = 0;
    for (int i = 0; i < 24; ++i) around += evenly_chosen(i, 24, 6, true) ? 1 : 0;
    CHECK(around == 6);
    const std::vector<SceneProblem> found =
        problems_of("[cloth]\nparticles = [11, 5]\n[[cloth.pin]]\nedge = [\"v0\", \"u0\"]\ncount = 8\n");
    REQUIRE(found.size() == 1);
    CHECK(found[0].place.line == 5);
    CHECK(found[0].what == "8 of the 5 particles along u0");
}

TEST_CASE("an included file's tables are taken over, the scene's own keys go before", "[scene]") {
    const Folder folder;
    folder.write("stage.toml",
                 "[clip]\nfps = 25\nduration = 2\n[[solid]]\nname = \"floor\"\nshape = "
                 "\"plane\"\n[look]\nground = \"#010203\"\n");
    folder.write(
        "base.toml",
        "include = \"stage.toml\"\n[clip]\nduration = 1.0\n[cloth]\ndensity = 0.3\nparticles = [11, 11]\n");
    folder.write("scene.toml",
                 "include = [\"base.toml\"]\n[cloth]\ncenter = [0, 2, 0]\nparticles = [21, "
                 "21]\n[[solid]]\nname = \"ball\"\n"
                 "shape = \"sphere\"\n");
    const Scene scene = load_scene(folder / "scene.toml");
    CHECK(scene.clip.fps == 25);
    CHECK(scene.clip.duration == 1.0);
    REQUIRE(scene.cloths.size() == 1);
    CHECK(scene.cloths[0].density == 0.3);
    CHECK(scene.cloths[0].particles == std::array{21, 21});
    REQUIRE(scene.solids.size() == 2);
    CHECK(scene.solids[0].name == "floor");
    CHECK(scene.solids[1].name == "ball");
    CHECK(scene.look.ground == "#010203");
    // Written out, it needs no other file.
    CHECK(parse_scene(scene_to_toml(scene), "a.toml").solids.size() == 2);
}

TEST_CASE("a problem in an included file is told with that file's line and column", "[scene]") {
    const Folder folder;
    const auto text_of = [&](const char* name) {
        try {
            load_scene(folder / name);
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    folder.write("stage.toml", "[clip]\nfps = 25\n\n[wind]\nvelocty = [1, 0, 0]\n");
    folder.write("a.toml", "include = [\"stage.toml\"]\n[cloth]\nsize = \"big\"\n");
    const std::string text = text_of("a.toml");
    CHECK(text.find((folder / "stage.toml").string() + ":5:1: error: unknown key 'velocty'") != text.npos);
    CHECK(text.find("    5 | velocty = [1, 0, 0]") != text.npos);
    CHECK(text.find((folder / "a.toml").string() + ":3:8: error: 'size' must be") != text.npos);
    folder.write("broken.toml", "[clip\n");
    folder.write("b.toml", "include = [\"broken.toml\"]\n[cloth]\n");
    CHECK(text_of("b.toml").find("broken.toml:1:6: error: this is not TOML") != text.npos);
    folder.write("c.toml", "include = [\"c.toml\", \"none.toml\", \"../../etc/passwd\"]\n[cloth]\n");
    const std::string refused = text_of("c.toml");
    CHECK(refused.find("c.toml:1:12: error: \"c.toml\" includes itself") != refused.npos);
    CHECK(refused.find("c.toml:1:22: error: no file \"none.toml\"") != refused.npos);
    CHECK(refused.find("c.toml:1:35: error: the included file \"../../etc/passwd\" is outside") !=
          refused.npos);
}

TEST_CASE("names that nothing has, circles, and rods that are none are refused", "[scene]") {
    const auto one = [](const std::string& text) {
        const std::vector<SceneProblem> found = problems_of(text);
        REQUIRE(found.size() == 1);
        return std::to_string(found[0].place.line) + " " + found[0].what;
    };
    const std::string cloth = "[cloth]\ncenter = [0, 3, 0]\n";
    CHECK(one(cloth + "[[cloth.pin]]\nedge = \"u0\"\nto = \"bodi\"\n[[solid]]\nname = \"body\"\nshape = "
                      "\"sphere\"\n") == "4 there is no solid \"bodi\"");
    CHECK(one(cloth + "[[cloth.pin]]\nedge = \"u0\"\nrod = \"body\"\n[[solid]]\nname = \"body\"\nshape = "
                      "\"sphere\"\n") == "4 the rod \"body\" is a sphere");
    CHECK(one(cloth +
              "[[solid]]\nname = \"a\"\nshape = \"sphere\"\nparent = \"b\"\n[[solid]]\nname = \"b\"\nshape = "
              "\"sphere\"\nparent = \"a\"\n") == "10 \"a\" would ride on itself");
    CHECK(one(cloth + "[[solid]]\nshape = \"sphere\"\ncenter = [0, 1, 0]\nfall = { floor = 0.9 }\n") ==
          "6 its lowest point begins 0.2 m below the floor");
    CHECK(one("gravity = [0, 0, 0]\n" + cloth + "[[solid]]\nshape = \"sphere\"\nfall = {}\n") ==
          "6 nothing falls without gravity");
}
