#include "sim/scene_file/load.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>

#include "sim/run/simulate.hpp"
#include "sim/scene/limits.hpp"
#include "sim/scene_file/presets.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(text, "test.toml", {}, overrides);
}

/// "line:column what; hint" of every problem; empty if the scene is accepted. Options show as "#n:column".
std::vector<std::string> problems_of(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
    std::vector<std::string> out;
    try {
        parse(text, overrides);
    } catch (const SceneError& error) {
        for (const SceneProblem& problem : error.problems()) {
            const SourcePlace& place = problem.place;
            out.push_back((place.option ? "#" + std::to_string(place.option) : std::to_string(place.line)) +
                          ":" + std::to_string(place.column) + " " + problem.what +
                          (problem.hint.empty() ? "" : "; " + problem.hint));
        }
    }
    return out;
}

using Problems = std::vector<std::string>;

}  // namespace

TEST_CASE("a scene of one empty cloth table has the documented defaults", "[scene]") {
    const Scene scene = parse("[cloth]\n");
    REQUIRE(scene.cloths.size() == 1);
    CHECK(scene.name == "test");
    CHECK(scene.cloths[0].particles == std::array{51, 51});
    CHECK(scene.cloths[0].name == "cloth");
    CHECK(scene.gravity == Vec3(0, -9.81, 0));
    CHECK(scene.solids.empty());
    CHECK(!scene.wind);
    CHECK(!scene.self_collision);
    CHECK(!scene.solver.adaptive);
    CHECK(scene.solver.integrator == Integrator::adaptive_imex);
    CHECK(scene.solver.preconditioner == Preconditioner::automatic);
    CHECK(scene.cameras.size() == 1);
    CHECK(scene.clip.frames() == 91);
}

TEST_CASE("the default step divides the frame and is at most 1/240 s", "[scene]") {
    for (const int fps : {1, 7, 24, 25, 30, 48, 60, 240, 241, 1000}) {
        const Scene scene = parse("[cloth]\n[clip]\nfps = " + std::to_string(fps) + "\n");
        const double steps = 1 / (fps * scene.solver.step);
        INFO("fps " << fps << ", step " << scene.solver.step);
        CHECK(std::abs(steps - std::round(steps)) < 1e-12 * steps);
        CHECK(scene.solver.step <= 1.0 / 240 * (1 + 1e-12));
        CHECK(scene.solver.step > 1.0 / 240 / 2 - 1e-12 - (fps > 240));
    }
}

TEST_CASE("rates of film and television are exact, and written as they were read", "[scene]") {
    for (const int num : {24000, 30000, 60000}) {
        const std::string rate = std::to_string(num) + "/1001";
        INFO(rate);
        const Scene scene = parse("[cloth]\n[clip]\nduration = 1001\nfps = \"" + rate + "\"\n");
        CHECK(scene.clip.fps == Rate(num, 1001));
        CHECK(scene.clip.frames() == num + 1);
        // A frame at a whole second is due at exactly that: no error has been summed.
        CHECK(scene.clip.fps.time_of(num) == 1001.0);
        CHECK(steps_per_frame(scene) * scene.solver.step == Approx(1001.0 / num).epsilon(1e-15));
        CHECK(scene.solver.step <= 1.0 / 240 * (1 + 1e-9));
        const std::string written = scene_to_toml(scene);
        CHECK(written.find("fps = \"" + rate + "\"") != std::string::npos);
        CHECK(parse(written).clip.fps == scene.clip.fps);
        const std::string step = step_text(scene.clip.fps, 12);
        CHECK(steps_per_frame(parse("[cloth]\n[clip]\nfps = \"" + rate + "\"\n[solver]\nstep = \"" + step +
                                    "\"\n")) == 12);
    }
    CHECK(parse("[cloth]\n[clip]\nfps = \"60/2\"\n").clip.fps == Rate(30));
}

TEST_CASE("a step may be a number or a fraction and is made to divide the frame exactly", "[scene]") {
    CHECK(parse("[cloth]\n[solver]\nstep = \"1/240\"\n").solver.step == 1.0 / 240);
    CHECK(parse("[cloth]\n[clip]\nfps = 25\n[solver]\nstep = 0.005\n").solver.step == 1.0 / 200);
    // Six digits of 1/120: the frame still ends at exactly 1/30.
    CHECK(parse("[cloth]\n[solver]\nstep = 0.00833333\n").solver.step == 1.0 / 120);
}

TEST_CASE("stretch takes a number or a pair, friction a number or a table", "[scene]") {
    const Scene scene = parse(R"(
        [cloth.material]
        stretch = 70
        stretch_damping = [0.1, 0.2]
        [[solid]]
        shape = "plane"
        center = [0, -1, 0]
        friction = 0.5
        [[solid]]
        shape = "plane"
        center = [0, -1, 0]
        friction = { static = 0.7 }
        [[solid]]
        shape = "plane"
        center = [0, -1, 0]
        friction = { static = 0.7, kinetic = 0.1 }
    )");
    CHECK(scene.cloths[0].material.stretch == std::array{70.0, 70.0});
    CHECK(scene.cloths[0].material.stretch_damping == std::array{0.1, 0.2});
    CHECK(scene.solids[0].friction.static_ == 0.5);
    CHECK(scene.solids[0].friction.kinetic == 0.8 * 0.5);
    CHECK(scene.solids[1].friction.kinetic == 0.8 * 0.7);
    CHECK(scene.solids[2].friction.kinetic == 0.1);
    CHECK(scene.solids[0].name == "plane");
    CHECK(scene.solids[2].name == "plane3");
}

TEST_CASE("a preset gives the numbers that are not said, and the density", "[scene]") {
    const MaterialPreset& denim = *find_preset("denim");
    const Scene plain = parse("[cloth.material]\npreset = \"denim\"\n");
    CHECK(plain.cloths[0].material.shear == denim.material.shear);
    CHECK(plain.cloths[0].density == denim.density);
    // The order of the keys does not matter.
    const Scene changed = parse("[cloth]\ndensity = 0.5\n[cloth.material]\nshear = 1\npreset = \"denim\"\n");
    CHECK(changed.cloths[0].material.shear == 1);
    CHECK(changed.cloths[0].material.bend == denim.material.bend);
    CHECK(changed.cloths[0].density == 0.5);
    const Scene region = parse(R"(
        [cloth]
        material = { preset = "cotton", shear = 40 }
        region = [{ box = [0, 0, 1, 0.5], material = { bend = 1e-3 } },
                  { box = [0, 0, 1, 0.1], material = { preset = "silk" } }]
    )");
    const std::vector<Region>& regions = region.cloths[0].regions;
    CHECK(regions[0].material->shear == 40);
    CHECK(regions[0].material->bend == 1e-3);
    CHECK(!regions[0].density);
    CHECK(regions[0].material->preset.empty());  // else it would bring its density when read back
    CHECK(regions[1].material->shear == find_preset("silk")->material.shear);
    CHECK(regions[1].density == find_preset("silk")->density);
}

TEST_CASE("each way to name pinned particles is read", "[scene]") {
    const Scene scene = parse(R"(
        [cloth]
        pin = [{ corner = ["u0v0", "u1v1"], release = 1 }, { edge = "v1" }, { particles = [0, 2, 3, 4] },
               { box = [0, 0.25, 1, 0.5] }, { disc = { center = [0.5, 0.25], radius = 0.1 } }]
    )");
    const std::vector<Pin>& pins = scene.cloths[0].pins;
    REQUIRE(pins.size() == 6);  // two corners are two pins
    CHECK(pins[0].name == "u0v0");
    CHECK(pins[1].name == "u1v1");
    CHECK(pins[1].release == 1.0);
    CHECK(pins[2].target == PinTarget::edge);
    CHECK(!pins[2].release);
    CHECK(pins[3].range == std::array{0, 2, 3, 4});
    CHECK(pins[4].box.low == Vec2(0, 0.25));
    CHECK(pins[4].box.high == Vec2(1, 0.5));
    CHECK(pins[5].disc.center == Vec2(0.5, 0.25));
    CHECK(pins[5].place.line == 4);
}

TEST_CASE("the smallest cloths are legal", "[scene]") {
    CHECK_NOTHROW(parse("[cloth]\nparticles = [1, 1]\n"));
    CHECK_NOTHROW(parse("[cloth]\nparticles = [1, 40]\n[[cloth.pin]]\ncorner = \"u0v0\"\n"));
    CHECK_NOTHROW(parse("[cloth]\nparticles = [3, 2]\nwrap = \"tube\"\n"));
    CHECK_NOTHROW(parse("[cloth]\nplaced_scale = [0, 0]\n"));
}

TEST_CASE("a cloth may start in a solid's skin, but no deeper than the skin is thick", "[scene]") {
    const auto scene = [](double y) {
        return "[cloth]\ncenter = [0, " + std::to_string(y) +
               ", 0]\n[solid]\nshape = \"plane\"\noffset = 0.01\n";
    };
    CHECK(problems_of(scene(0.0)).empty());
    CHECK(problems_of(scene(-0.009)).empty());
    CHECK(problems_of(scene(-0.011)).size() == 1);
}

TEST_CASE("a single particle inside a solid is found wherever it is", "[scene]") {
    // The ball is smaller than the spacing, so no other particle is near enough to betray it.
    for (const int target : {0, 1, 17, 59, 60, 61, 3000, 3599}) {
        const int i = target % 60, j = target / 60;
        const std::string x = std::to_string(-0.5 + i / 59.0), z = std::to_string(-0.5 + j / 59.0);
        const auto found = problems_of(
            "[cloth]\nparticles = [60, 60]\n[solid]\nshape = \"sphere\"\nradius = 0.006\noffset = 0.001\n"
            "center = [" +
            x + ", 0, " + z + "]\n");
        REQUIRE(found.size() == 1);
        const std::string name = "particle (" + std::to_string(i) + ", " + std::to_string(j) + ")";
        CHECK_THAT(found[0], Catch::Contains(name));
    }
}

TEST_CASE("a file that is too large or can't be read is refused", "[scene]") {
    CHECK_THROWS_AS(load_scene("/no/such/scene.toml"), std::system_error);
    CHECK_THROWS_AS(load_scene("/"), std::system_error);
    const Problems problems = problems_of(std::string(max_scene_bytes + 1, '\n'));
    REQUIRE(problems.size() == 1);
    CHECK_THAT(problems[0], Catch::Contains("too large"));
}

TEST_CASE("a large file that is no scene is refused with a bounded list of problems", "[scene]") {
    std::string text;
    for (int i = 0; text.size() + 20 < max_scene_bytes; ++i) text += "k" + std::to_string(i) + "=1\n";
    CHECK(problems_of(text).size() <= max_problems + 1);
}

TEST_CASE("text that is no UTF-8 or holds control characters is refused and never echoed raw", "[scene]") {
    for (const std::string& text :
         {std::string("[cloth]\nname = \"a\xff\"\n"), std::string("[cloth]\nname = \"a\0b\"\n", 21),
          std::string("[cloth]\n\x1b[31m = 1\n"), std::string("[cloth]\n\"\\u001b[31m\" = 1\n")}) {
        try {
            parse(text);
            FAIL("accepted");
        } catch (const SceneError& error) {
            CHECK_THAT(error.what(), !Catch::Contains("\x1b"));
            CHECK(std::string(error.what()).find('\0') == std::string::npos);
        }
    }
}

TEST_CASE("a texture may be linked within the scene's folder but not out of it", "[scene]") {
    namespace fs = std::filesystem;
    const fs::path root = fs::temp_directory_path() / "unravel_texture_test";
    fs::remove_all(root);
    fs::create_directories(root / "scene" / "pictures");
    std::ofstream(root / "outside.png") << "x";
    std::ofstream(root / "scene" / "pictures" / "inside.png") << "x";
    fs::create_symlink("../outside.png", root / "scene" / "out.png");
    fs::create_symlink("pictures/inside.png", root / "scene" / "in.png");
    fs::create_directory_symlink(root, root / "scene" / "up");
    const auto accepted = [&](const std::string& texture) {
        try {
            parse_scene("[cloth]\n[look.cloth]\ntexture = \"" + texture + "\"\n", "t.toml", root / "scene");
            return true;
        } catch (const SceneError&) {
            return false;
        }
    };
    CHECK(accepted("in.png"));
    CHECK(accepted("pictures/inside.png"));
    CHECK(accepted("pictures/../pictures/inside.png"));
    CHECK(!accepted("out.png"));
    CHECK(!accepted("up/outside.png"));
    CHECK(!accepted("pictures"));
    fs::remove_all(root);
}
