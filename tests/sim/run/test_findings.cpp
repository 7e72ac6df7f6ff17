// What is told at the end of a run, and the counts that it is told from.

#include <algorithm>
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
    const Scene scene = sheet_at(1);
    const Simulation simulation = start_simulation(scene);
    CHECK(findings(scene, simulation.model, {}).empty());
    StepReport quiet;
    quiet.crossings = 0;
    quiet.in_solids = 0;
    quiet.max_strain = 0.19;
    CHECK(findings(scene, simulation.model, std::vector<StepReport>(3, quiet)).empty());
}

TEST_CASE("strain is told with its place and time, crossings with the first and the most", "[findings]") {
    const Scene scene = sheet_at(1);
    const Simulation simulation = start_simulation(scene);
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
    const std::vector<std::string> lines = findings(scene, simulation.model, reports);
    REQUIRE(lines.size() == 4);
    CHECK_THAT(lines[0], Contains("particle 0 (u 0, v 0)") && Contains("31%") && Contains("0.03 s (step 3)"));
    CHECK_THAT(lines[1],
               Contains("from 0.02 s on: 1 edge there, at most 7 at 0.04 s") && Contains("[self_collision]"));
    CHECK_THAT(lines[2], Contains("2 edges") && Contains("3 mm deep"));
    CHECK_THAT(lines[3], Contains("first at 0.01 s, at most 5"));
}

namespace {

// What is told at the end of a run of the scene.
std::vector<std::string> told(const Scene& scene) {
    Simulation simulation = start_simulation(scene);
    std::vector<StepReport> reports;
    for (int frame = 1; frame < scene.clip.frames(); ++frame) {
        const FrameRecord record = next_record(simulation);
        reports.insert(reports.end(), record.reports.begin(), record.reports.end());
    }
    return findings(scene, simulation.model, reports);
}

Scene parsed(const std::string& text) {
    return parse_scene(text, "scene.toml");
}

constexpr const char* short_clip = "[clip]\nduration = 0.08\nfps = 25\n";

}  // namespace

TEST_CASE("steps that end short of their tolerance are told, of Newton's method and of too few iterations",
          "[findings]") {
    const std::string silk = std::string(short_clip) +
                             "[cloth]\nparticles = [21, 21]\nmaterial = { preset = \"silk\" }\n"
                             "[[cloth.pin]]\nedge = \"u0\"\n[solver]\nstep = \"1/50\"\n";
    const std::vector<std::string> few = told(parsed(silk + "tolerance = 1e-12\nmax_iterations = 40\n"));
    REQUIRE(!few.empty());
    CHECK_THAT(few[0], Contains("of 4 steps did not reach the tolerance 1e-12 within 40 iterations") &&
                           Contains("the first at 0.0"));
    const Scene newton = parsed(silk + "integrator = \"newton\"\ntolerance = 1e-14\n");
    const Simulation simulation = start_simulation(newton);
    std::vector<StepReport> reports(10);
    reports[3].converged = false;
    CHECK_THAT(findings(newton, simulation.model, reports).at(0),
               Contains("1 of 10 steps") && Contains("Newton's method"));
}

TEST_CASE("steps taken again are told where they are many, and where steps do not adapt anyway",
          "[findings]") {
    Scene scene = sheet_at(1);
    const Simulation simulation = start_simulation(scene);
    std::vector<StepReport> reports(100);
    for (std::size_t k = 0; k < 5; ++k) reports[10 + k].rejected = 1;
    CHECK(findings(scene, simulation.model, reports).empty());
    reports[20].rejected = 1;
    reports[10].t = 0.25;
    CHECK_THAT(findings(scene, simulation.model, reports).at(0),
               Contains("6 of 100 steps were taken again") && Contains("first at 0.25 s"));
    scene.solver.adaptive = AdaptiveStep{};
    CHECK(findings(scene, simulation.model, reports).empty());
}

TEST_CASE("wind that explicit steps do not bear is told, and what implicit ones bear is not", "[findings]") {
    // ½ ρ A v of a cell is many times a corner's mass over the step.
    const std::string veil = "gravity = [0, 0, 0]\n" + std::string(short_clip) +
                             "[cloth]\nparticles = [5, 5]\ndensity = 0.01\n"
                             "material = { stretch = 0.01, shear = 0, bend = 0, stretch_damping = 0 }\n"
                             "[[cloth.pin]]\nedge = [\"u0\", \"u1\", \"v0\", \"v1\"]\n"
                             "[wind]\nvelocity = [0, 1, 0]\n[solver]\nstep = \"1/25\"\n";
    const std::vector<std::string> held = told(parsed(veil + "integrator = \"explicit\"\n"));
    CHECK(std::ranges::any_of(held, [](const auto& line) {
        return line.find("cells less than it would, first at 0.04 s") != line.npos;
    }));
    for (const std::string& line : told(parsed(veil))) CHECK_THAT(line, !Contains("the wind pushes"));
}

TEST_CASE("cloth that moves at the end is told unless something drives it", "[findings]") {
    const std::string falling = std::string(short_clip) + "[cloth]\nparticles = [5, 5]\n";
    CHECK_THAT(told(parsed(falling)).at(0), Contains("still moves at the end, at 0.7"));  // g · 0.08 s
    CHECK(told(parsed(falling + "[wind]\nvelocity = [1, 0, 0]\n")).empty());
    CHECK(told(parsed("gravity = [0, 0, 0]\n" + falling)).empty());
    // Carried along, then let stand.
    const std::string carried = falling + "[[cloth.pin]]\nedge = \"u0\"\nmotion = [{ time = 0 }, { time = ";
    CHECK(told(parsed(carried + "1, position = [1, 0, 0] }]\n")).empty());
    CHECK(!told(parsed(carried + "0.05, position = [0.1, 0, 0] }]\n")).empty());
}

TEST_CASE("effects that had nothing to do are told by name", "[findings]") {
    const std::string still = "gravity = [0, 0, 0]\n" + std::string(short_clip) +
                              "[cloth]\nparticles = [21, 21]\ncenter = [0, 1, 0]\n";
    const std::string ball = "[[solid]]\nshape = \"sphere\"\nradius = 0.1\n";
    CHECK_THAT(told(parsed(still + ball)).at(0), Contains("the solid was never touched"));
    CHECK_THAT(told(parsed(still + ball + ball + "center = [0, -1, 0]\n")).at(0),
               Contains("all the solids were never touched"));
    CHECK_THAT(told(parsed(still + "[self_collision]\n")).at(0), Contains("[self_collision] never had"));
    CHECK_THAT(told(parsed(still + "[wind]\ndensity = 0\nvelocity = [3, 0, 0]\n")).at(0),
               Contains("[wind] did nothing"));
    // One that is touched is no news.
    const std::string lying = std::string(short_clip) +
                              "[cloth]\nparticles = [5, 5]\ncenter = [0, 0.004, 0]\n"
                              "[[solid]]\nshape = \"plane\"\n";
    CHECK(told(parsed(lying)).empty());
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
