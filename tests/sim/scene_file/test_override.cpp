#include <catch2/catch.hpp>

#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

const std::string one_cloth = "[clip]\nfps = 25\n[cloth]\n[solver]\nstep = 0.005\n";
const std::string two_of_each =
    "[[cloth]]\n[[cloth]]\ncenter = [3, 0, 0]\n[[solid]]\nshape = \"sphere\"\ncenter = [0, -3, 0]\n"
    "[[solid]]\nshape = \"plane\"\ncenter = [0, -3, 0]\n";

Scene parse(const std::string& text, const std::vector<std::string>& overrides) {
    return parse_scene(text, "test.toml", {}, overrides);
}

/// The only problem, as "column what; hint", which has to be in option 1.
std::string problem_of(const std::string& text, const std::string& option) {
    try {
        parse(text, {option});
    } catch (const SceneError& error) {
        REQUIRE(error.problems().size() == 1);
        const SceneProblem& problem = error.problems()[0];
        CHECK(problem.place.option == 1);
        return std::to_string(problem.place.column) + " " + problem.what +
               (problem.hint.empty() ? "" : "; " + problem.hint);
    }
    return "";
}

}  // namespace

TEST_CASE("options change values of the file, the last one wins", "[scene]") {
    const Scene scene =
        parse(one_cloth, {"cloth.particles=[11, 21]", "solver.step = 0.01", "clip.duration=1",
                          "clip.duration=2", "solver.integrator=implicit", "solver.preconditioner=\"ic0\""});
    CHECK(scene.cloths[0].particles == std::array{11, 21});
    CHECK(scene.solver.step == 0.01);
    CHECK(scene.clip.duration == 2);
    CHECK(scene.solver.integrator == Integrator::implicit);
    CHECK(scene.solver.preconditioner == Preconditioner::ic0);
}

TEST_CASE("options may make tables that the file has not", "[scene]") {
    const Scene scene =
        parse(one_cloth, {"wind.velocity=[1, 0, 0]", "wind.gust.period=2", "cloth.material.preset=silk",
                          "self_collision={}", "solver.step=1/250"});
    REQUIRE(scene.wind);
    CHECK(scene.wind->velocity == Vec3(1, 0, 0));
    CHECK(scene.wind->gust->period == 2);
    CHECK(scene.self_collision);
    CHECK(scene.cloths[0].material.preset == "silk");
    CHECK(scene.solver.step == 1.0 / 250);
}

TEST_CASE("options reach one of several cloths or solids by its number", "[scene]") {
    const Scene scene =
        parse(two_of_each, {"cloth[1].density=0.7", "solid[0].radius=0.2", "cloth[1].center[0]=4"});
    CHECK(scene.cloths[0].density == 0.2);
    CHECK(scene.cloths[1].density == 0.7);
    CHECK(scene.cloths[1].center == Vec3(4, 0, 0));
    CHECK(scene.solids[0].radius == 0.2);
    CHECK(problem_of(two_of_each, "cloth.density=0.7") ==
          "1 the scene has 2 of 'cloth'; say which: cloth[0] …");
    CHECK(problem_of(two_of_each, "solid[2].radius=1") ==
          "1 there is no solid[2]; the scene has 2, counted from 0");
}

TEST_CASE("a problem in an option is shown in the option", "[scene]") {
    CHECK(problem_of(one_cloth, "solver.step=0.006") ==
          "13 the step of 0.006 s does not divide a frame of 1/25 s; the nearest that does is \"1/175\"");
    CHECK(problem_of(one_cloth, "solver.stepp=0.005") == "8 unknown key 'stepp'; did you mean 'step'?");
    CHECK(problem_of(one_cloth, "sovler.threshold=0.1") == "1 unknown key 'sovler'; did you mean 'solver'?");
    CHECK(problem_of(one_cloth, "cloth.step=0.005") == "7 unknown key 'step'; it belongs in [solver]");
    CHECK(problem_of(one_cloth, "cloth.particles=[11, nan]") ==
          "22 'particles' must be a whole number, not a decimal number");
    CHECK(problem_of(one_cloth, "cloth.density= -1") ==
          "16 'density' is -1; it must be from 0.0001 to 1000 kg/m²");
    CHECK(problem_of(one_cloth, "solver.integrator=implict") ==
          "19 'integrator' can't be \"implict\"; did you mean \"implicit\"?");
    CHECK(problem_of(one_cloth, "solver.step.x=1") == "13 'step' is a decimal number and has no 'x'");
}

TEST_CASE("what is no option is refused with what one looks like", "[scene]") {
    for (const std::string option :
         {"", "solver.step", "=1", ".step=1", "solver..step=1", "solver.=1", "cloth[.density=1",
          "cloth[-1].density=1", "cloth[99999999999999999999].x=1",
          "a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r=1"}) {
        INFO(option);
        CHECK(problem_of(one_cloth, option) != "");
    }
    for (const std::string value : {"", " ", "[1, 2", "\"open", "1\nsolver.decompose=false", "one\ntwo",
                                    "1\n", "{a=1", "1, 2", "= 3"}) {
        INFO(value);
        CHECK_THAT(problem_of(one_cloth, "clip.duration=" + value), Catch::StartsWith("15 this is no value"));
    }
}
