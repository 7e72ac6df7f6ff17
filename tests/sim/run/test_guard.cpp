#include "sim/run/guard.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/run/frame_record.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

Simulation hanging_sheet(const std::vector<std::string>& set = {}) {
    return start_simulation(
        parse_scene("[clip]\nfps = 25\n[cloth]\nparticles = [6, 6]\nsize = [0.5, 0.5]\n"
                    "[[cloth.pin]]\ncorner = [\"u0v0\", \"u1v0\"]\n"
                    "[solver]\nstep = \"1/200\"\n",
                    "sheet.toml", {}, set));
}

StepFailure failure_of(Simulation& s) {
    try {
        for (int k = 0; k < 400; ++k) guarded_step(s.model, s.options, 1.0 / 200, s.state, s.ws, s.guard);
    } catch (const SimulationError& error) {
        // The message is for people who have nothing else.
        CHECK(std::string(error.what()).find(error.failure().advice) != std::string::npos);
        CHECK(std::string(error.what()).find("step ") == 0);
        return error.failure();
    }
    FAIL("nothing stopped it");
    return {};
}

}  // namespace

TEST_CASE("a failing step leaves the state as it was") {
    Simulation s = hanging_sheet();
    for (int k = 0; k < 10; ++k) guarded_step(s.model, s.options, 1.0 / 200, s.state, s.ws, s.guard);
    s.guard.strain = -2;  // nothing passes
    const std::uint64_t before = state_hash(s.state);
    const Vec3 dv = s.state.dv[7];
    CHECK_THROWS_AS(guarded_step(s.model, s.options, 1.0 / 200, s.state, s.ws, s.guard), SimulationError);
    CHECK(state_hash(s.state) == before);
    CHECK(s.state.dv[7] == dv);
    CHECK(s.state.step == 10);
}

TEST_CASE("strain beyond the bound names the spring and its ends") {
    Simulation s = hanging_sheet({"cloth.density=5", "cloth.material.stretch=0.01", "cloth.material.shear=0",
                                  "cloth.material.bend=0"});
    const StepFailure failure = failure_of(s);
    CHECK(failure.criterion == Criterion::strain);
    CHECK(failure.value > failure.limit);
    REQUIRE(failure.spring);
    const std::uint32_t i = s.model.springs.i[*failure.spring], j = s.model.springs.j[*failure.spring];
    REQUIRE(!failure.particles.empty());
    CHECK((failure.particles.front() == i || failure.particles.front() == j));
}

TEST_CASE("energy that comes from nowhere stops an unpinned and a pinned cloth") {
    Simulation s = hanging_sheet({"solver.integrator=\"explicit\"", "cloth.material.stretch=5000"});
    const StepFailure failure = failure_of(s);
    CHECK((failure.criterion == Criterion::energy || failure.criterion == Criterion::strain));
    Simulation flung = hanging_sheet();
    flung.guard.strain = Guard::infinite;
    for (Vec3& v : flung.state.v) v = Vec3(1000, 0, 0);
    CHECK(failure_of(flung).criterion == Criterion::energy);
}

TEST_CASE("an effect that cannot act leaves the energy guarded, and changes no bit") {
    // Silk held at an edge, a step a frame: strain 0.17 and 1.3 J from nowhere where nothing guards it.
    const std::string sheet =
        "[clip]\nfps = 30\n[cloth]\nparticles = [21, 21]\nmaterial = { preset = \"silk\" }\n"
        "[solver]\nstep = \"1/30\"\n";
    const std::string pin = "[[cloth.pin]]\nedge = \"u0\"\n";
    const std::string idle[] = {
        pin,
        pin + "[self_collision]\n",
        pin +
            "[[solid]]\nshape = \"sphere\"\nradius = 0.1\ncenter = [100, 0, 0]\n"
            "motion = [{ time = 0 }, { time = 1, position = [0, 1, 0] }]\n",
        pin + "[wind]\nvelocity = [5, 0, 0]\ndensity = 0\n",
        pin + "motion = [{ time = 0 }, { time = 1 }]\n",
    };
    std::uint64_t bare = 0;
    for (const std::string& effect : idle) {
        INFO(effect);
        Simulation s = start_simulation(parse_scene(sheet + effect, "sheet.toml"));
        double energy = s.guard.total, most_strain = 0;
        for (int k = 0; k < 15; ++k) {
            const StepReport report = next_step(s);
            CHECK(report.kinetic + report.potential <= energy + s.guard.rounding);
            energy = report.kinetic + report.potential;
            most_strain = std::max(most_strain, report.max_strain);
        }
        CHECK(most_strain < 0.01);
        if (bare == 0) bare = state_hash(s.state);
        CHECK(state_hash(s.state) == bare);
    }
}

TEST_CASE("what pins, solids and wind put in is no fault") {
    const std::string acts[] = {
        "[[cloth.pin]]\nedge = \"u0\"\nmotion = [{ time = 0 }, { time = 0.5, position = [0, 1, 0] }]\n",
        "[[solid]]\nshape = \"box\"\nsize = [1, 0.2, 1]\ncenter = [0, -0.12, 0]\n"
        "motion = [{ time = 0 }, { time = 0.5, position = [0, 1, 0] }]\n",
        "[[cloth.pin]]\nedge = \"u0\"\n[wind]\nvelocity = [0, 20, 0]\n",
    };
    for (const std::string& act : acts) {
        INFO(act);
        Simulation s = start_simulation(parse_scene(
            "[clip]\nfps = 20\n[cloth]\nparticles = [9, 9]\nsize = [0.5, 0.5]\n" + act, "sheet.toml"));
        const double start = s.guard.total;
        double most = start;
        int again = 0, steps = 0;
        for (int k = 0; k < 10; ++k) {
            for (const StepReport& report : next_record(s).reports) {
                most = std::max(most, report.kinetic + report.potential);
                again += report.rejected > 0;
                ++steps;
            }
        }
        CHECK(most > start + 0.05);  // J, of half a newton lifted
        CHECK(10 * again < steps);
    }
}

TEST_CASE("energy that swings where springs are explicit is no reason to take a step again") {
    // Undamped, threads along u explicit and across them implicit: waves run along u, and their energy swings
    // by h/2 v·f.
    Simulation s = start_simulation(parse_scene(
        "gravity = [0, 0, 0]\n[cloth]\nparticles = [21, 21]\nplaced_scale = [1.1, 1.1]\n"
        "[cloth.material]\nstretch = [4, 20]\nstretch_damping = 0\nshear = 0.1\nshear_damping = 0\n"
        "bend = 0\n[[cloth.pin]]\nedge = [\"u0\", \"u1\"]\n[solver]\nstep = \"1/240\"\n",
        "sheet.toml"));
    const ClothPatch& patch = s.model.cloths[0];
    for (int j = 0; j < 21; ++j) {
        for (int i = 0; i < 21; ++i)
            s.state.v[patch.at(i, j)].x() = 0.3 * std::sin(std::numbers::pi * i / 20);
    }
    s.guard = make_guard(s.model, s.state, 1.0 / 240);
    const double start = s.guard.total;
    double energy = start;
    int again = 0, grew = 0;
    for (int k = 0; k < 120; ++k) {
        const StepReport report = next_step(s);
        CHECK((report.implicit > 0 && report.explicit_ > 0));
        grew += report.kinetic + report.potential > energy + s.guard.rounding;
        energy = report.kinetic + report.potential;
        again += report.rejected > 0;
        CHECK(energy < 1.02 * start);
    }
    CHECK(grew > 12);
    CHECK(again == 0);
}

TEST_CASE("a NaN stops the run at its particle") {
    Simulation s = hanging_sheet();
    s.state.v[20] = Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0);
    const StepFailure failure = failure_of(s);
    CHECK(failure.criterion == Criterion::not_finite);
    CHECK(failure.step == 1);
}

TEST_CASE("conjugate gradients that end far from the solution stop the run") {
    Simulation s = hanging_sheet({"cloth.material.stretch=1e6", "solver.max_iterations=1"});
    s.guard.energy = s.guard.strain = Guard::infinite;
    const StepFailure failure = failure_of(s);
    CHECK(failure.criterion == Criterion::unsolved);
    CHECK(failure.value > failure.limit);
    CHECK(!failure.particles.empty());
}

TEST_CASE("energy never grows: a step that would add some is taken again") {
    // One step a frame: rows turn far and springs go taut within it.
    const std::vector<std::string> coarse{"solver.step=\"1/25\"", "solver.activation_band=0",
                                          "cloth.particles=[16, 16]", "cloth.material.stretch=500"};
    Simulation s = hanging_sheet(coarse), plain = hanging_sheet(coarse);
    double energy = s.guard.total, once = energy;
    int again = 0, grew = 0;
    for (int k = 0; k < 40; ++k) {
        const StepReport report = next_step(s);
        const double now = report.kinetic + report.potential;
        CHECK(now <= energy + s.guard.rounding);
        energy = now;
        again += report.rejected > 0;
        const StepReport one = step(plain.model, plain.options, 1.0 / 25, plain.state, plain.ws);
        grew += one.kinetic + one.potential > once + s.guard.rounding;
        once = one.kinetic + one.potential;
    }
    CHECK(again > 0);
    CHECK(grew > 0);  // without the guard
}

TEST_CASE("steps taken again are taken again after a resume") {
    Simulation whole = hanging_sheet({"solver.step=\"1/25\""});
    Simulation resumed = hanging_sheet({"solver.step=\"1/25\""});
    for (int frame = 1; frame <= 12; ++frame) {
        const FrameRecord record = next_record(whole);
        if (frame > 1) CHECK(state_hash(next_record(resumed).state) == state_hash(record.state));
        resumed = hanging_sheet({"solver.step=\"1/25\""});
        restore(resumed, record);
    }
}
TEST_CASE("a free sheet at rest stays at rest") {
    for (const char* step : {"1/240", "1/990"}) {
        Simulation s = start_simulation(parse_scene(
            "gravity = [0, 0, 0]\n[cloth]\nparticles = [15, 19]\nsize = [0.348007, 0.484755]\n"
            "center = [0.08, 0.11, 0.014]\nmaterial = { preset = \"cotton\" }\n[solver]\nstep = \"" +
                std::string(step) + "\"\n",
            "sheet.toml"));
        const std::vector<Vec3> start = s.state.x;
        for (int k = 0; k < 30; ++k) next_step(s);
        for (std::size_t p = 0; p < start.size(); ++p) CHECK((s.state.x[p] - start[p]).norm() < 1e-10);
    }
}

TEST_CASE("Newton's method is done at once where nothing moves") {
    Simulation s = start_simulation(
        parse_scene("gravity = [0, 0, 0]\n[cloth]\nparticles = [21, 21]\nmaterial = { preset = \"cotton\" }\n"
                    "[[cloth.pin]]\nedge = \"v0\"\n[solver]\nintegrator = \"newton\"\n",
                    "sheet.toml"));
    for (int k = 0; k < 10; ++k) {
        const StepReport report = next_step(s);
        CHECK(report.converged);
        CHECK(report.cg_iterations < 200);  // a solve or two, of 30
    }
}

TEST_CASE("a run that is stopped for what is lifted, not thrown, is stopped with words") {
    Simulation s = start_simulation(parse_scene(
        "[clip]\nfps = 10\n[cloth]\nparticles = [11, 11]\nsize = [0.1, 0.1]\ncenter = [0, 0.01, 0]\n"
        "[[solid]]\nshape = \"plane\"\noffset = 0.5\n",
        "sheet.toml"));
    s.guard.energy = 0;
    std::string words;
    try {
        for (int k = 0; k < 12; ++k) next_record(s);
    } catch (const SimulationError& stopped) {
        words = stopped.what();
    }
    CHECK(words.find("it is lifted") != std::string::npos);
}

TEST_CASE("where damping is too hard for the solver's tolerance the advice says so, and helps") {
    const auto run = [](const std::string& tolerance) {
        Simulation s = start_simulation(
            parse_scene("[clip]\nduration = 0.2\n[cloth]\nparticles = [21, 21]\nsize = [0.1, 0.1]\n"
                        "material = { stretch_damping = 1e4 }\n[[cloth.pin]]\ncorner = [\"u0v0\", \"u1v0\"]\n"
                        "[solver]\ntolerance = " +
                            tolerance + "\n",
                        "damped.toml"));
        for (int k = 0; k < 6; ++k) next_record(s);
    };
    std::string advised;
    try {
        run("1e-3");
    } catch (const SimulationError& error) {
        const std::string says = "lower solver.tolerance to ", advice = error.failure().advice;
        REQUIRE(advice.find(says) == 0);
        advised = advice.substr(says.size(), advice.find(' ', says.size()) - says.size());
    }
    REQUIRE(!advised.empty());
    CHECK_NOTHROW(run(advised));
}

TEST_CASE("a run that goes on from a record is held to the energies that it was held to before") {
    const Scene scene = parse_scene(
        "[clip]\nfps = 25\nsettle = 0.08\n[cloth]\nparticles = [9, 9]\nmaterial = { preset = \"cotton\" }\n"
        "[[cloth.pin]]\nedge = \"u0\"\nmotion = [{ time = 0 }, { time = 0.2, position = [0, 1, 0] }]\n",
        "sheet.toml");
    Simulation run = start_simulation(scene);
    settle(run);
    FrameRecord record = present_record(run);
    for (int frame = 0; frame < 4; ++frame) {
        INFO(frame);
        Simulation other = start_simulation(scene);
        restore(other, record);
        CHECK(other.guard.total == run.guard.total);
        CHECK(other.guard.energy == run.guard.energy);
        record = next_record(run);
        const FrameRecord again = next_record(other);
        CHECK(other.guard.energy == run.guard.energy);
        CHECK(state_hash(again.state) == state_hash(record.state));
    }
}

TEST_CASE("cloth that is thrown about a solid gains no energy: a step that does is divided") {
    // Held by a strip and thrown at 22 m/s, a box in its way; from 0.35 J it came to 4.4 J of springs.
    const Scene scene = load_scene(UNRAVEL_SOURCE_DIR "/tests/random_scenes/found/thrown_about.toml");
    Simulation run = start_simulation(scene);
    double lowest = Guard::infinite;
    for (int k = 0; k < 18; ++k) {
        const StepReport report = next_step(run);
        const double energy = report.kinetic + report.potential;
        CHECK(energy <= 1.05 * lowest);
        lowest = std::min(lowest, energy);
    }
}

TEST_CASE("cloth that starts within a solid's skin is lifted onto it, however thick that is") {
    Simulation run = start_simulation(
        parse_scene("[cloth]\nparticles = [11, 11]\nsize = [0.1, 0.1]\ncenter = [0, 0.01, 0]\n"
                    "[[solid]]\nshape = \"plane\"\noffset = 0.5\n",
                    "lifted.toml"));
    for (int k = 0; k < 300; ++k) next_step(run);
    for (const Vec3& x : run.state.x) CHECK(x.y() == Approx(0.5).margin(1e-3));
}
