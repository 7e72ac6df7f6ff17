// What is told at the end of a run, and the counts that it is told from.

#include <catch2/catch.hpp>

#include "sim/run/findings.hpp"
#include "sim/run/passages.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;
using Catch::Contains;

namespace {

// A sheet of 5 × 5 particles, 0.1 m apart, flat at a height; and what further tables say.
Scene sheet_at(double height, const std::string& further = {}) {
    return parse_scene(
        "gravity = [0, 0, 0]\n[[cloth]]\nparticles = [5, 5]\nsize = [0.4, 0.4]\ncenter = [0, " +
            std::to_string(height) + ", 0]\n" + further,
        "sheet.toml");
}

Passages at_start(const Scene& scene) {
    const Simulation simulation = start_simulation(scene);
    return find_passages(simulation.model, 0, simulation.state.x);
}

}  // namespace

TEST_CASE("a run in which nothing happened has nothing to tell", "[findings]") {
    const Simulation simulation = start_simulation(sheet_at(1));
    CHECK(findings(simulation.model, {}).empty());
    StepReport quiet;
    quiet.crossings = 0;
    quiet.in_solids = 0;
    quiet.max_strain = 0.19;
    CHECK(findings(simulation.model, std::vector<StepReport>(3, quiet)).empty());
}

TEST_CASE("strain is told with its place and time, crossings with the first and the most", "[findings]") {
    const Simulation simulation = start_simulation(sheet_at(1));
    std::vector<StepReport> reports(4);
    for (std::size_t k = 0; k < 4; ++k) {
        reports[k].step = k + 1;
        reports[k].t = 0.01 * static_cast<double>(k + 1);
    }
    reports[2].max_strain = 0.31;
    reports[2].strained = 0;
    reports[1].crossings = 1;
    reports[3].crossings = 7;
    reports[3].in_solids = 2;
    reports[3].deepest = 0.003;
    reports[0].pulling = 5;
    const std::vector<std::string> lines = findings(simulation.model, reports);
    REQUIRE(lines.size() == 4);
    CHECK_THAT(lines[0], Contains("particle 0 (u 0, v 0)") && Contains("31%") && Contains("0.03 s (step 3)"));
    CHECK_THAT(lines[1],
               Contains("from 0.02 s on: 1 edge there, at most 7 at 0.04 s") && Contains("[self_collision]"));
    CHECK_THAT(lines[2], Contains("2 edges") && Contains("3 mm deep"));
    CHECK_THAT(lines[3], Contains("first at 0.01 s, at most 5"));
}

TEST_CASE("edges through a rod, a plate and a corner are counted, what sags onto a ball is not",
          "[findings]") {
    // A rod along a row of cells' middles: the five threads across it are cut, and the four diagonals.
    const std::string rod =
        "[[solid]]\nshape = \"cylinder\"\nradius = 0.005\nheight = 2\nrotation = [0, 0, 90]\n";
    const Passages cut = at_start(sheet_at(1, rod + "center = [0, 1, 0.05]\n"));
    CHECK(cut.solids == 9);
    CHECK(cut.deepest == Approx(0.005).margin(6e-4));
    CHECK(at_start(sheet_at(1, rod + "center = [0, 1.011, 0.05]\n")).solids == 0);

    // A plate of 2 mm, thinner than twice its skin, across the same cells.
    const std::string plate = "[[solid]]\nshape = \"box\"\nsize = [1, 0.3, 0.002]\n";
    CHECK(at_start(sheet_at(1, plate + "center = [0, 1, 0.05]\n")).solids == 9);

    // The tip of a box between particles cuts no edge, but is there.
    const Passages tip = at_start(sheet_at(1,
                                           "[[solid]]\nshape = \"box\"\nsize = [0.02, 0.02, 0.02]\ncenter = "
                                           "[0.05, 1, 0.025]\n"));
    CHECK(tip.solids == 0);
    CHECK(tip.deepest == Approx(0.01).margin(6e-4));

    // Four particles 0.5 mm above a ball of 1 m, and 2 mm of it above the middle between them.
    const Scene ball = parse_scene(
        "[[cloth]]\nparticles = [4, 4]\nsize = [0.3, 0.3]\ncenter = [0, 0.998, 0]\n"
        "[[solid]]\nshape = \"sphere\"\nradius = 1\n",
        "ball.toml");
    const Passages sag = at_start(ball);
    CHECK(sag.solids == 0);
    CHECK(sag.deepest == Approx(0.002).margin(6e-4));
}

TEST_CASE("crossings are counted where cloth may meet cloth, and only there", "[findings]") {
    CHECK(!at_start(sheet_at(1)).cloth_count());
    CHECK(at_start(sheet_at(1, "[self_collision]\n")).cloth_count() == 0);
    // A ribbon that stands in a cell of the sheet and leans, so that its threads pass through it.
    const std::string ribbon =
        "[[cloth]]\nparticles = [2, 2]\nsize = [0.05, 0.1]\nrotation = [90, 0, 0]\ncenter = [0.05, 1, "
        "0.03]\n";
    CHECK(at_start(sheet_at(1, ribbon)).cloth_count().value() >= 2);
    Simulation simulation = start_simulation(sheet_at(1, ribbon));
    const FrameRecord record = next_record(simulation);
    CHECK(record.reports.back().crossings.value() >= 2);
    CHECK(!record.reports.front().crossings);
}
