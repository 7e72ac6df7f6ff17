// The step size chosen while running.

#include <catch2/catch.hpp>
#include <set>

#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

Scene adaptive_drape(double max_strain) {
    Scene scene = drape();
    scene.solver.activation_band = 0;
    scene.solver.step = 1.0 / 50;
    scene.solver.adaptive = AdaptiveStep{};
    scene.solver.adaptive->max_strain = max_strain;
    scene.solver.adaptive->smallest = 1.0 / 6400;
    return scene;
}

}  // namespace

TEST_CASE("adaptive steps meet every frame exactly, with sizes that are halvings of the scene's") {
    Simulation simulation = start_simulation(adaptive_drape(0.01));
    std::set<double> sizes;
    std::uint32_t rejected = 0;
    for (int k = 1; k <= 15; ++k) {
        const FrameRecord record = next_record(simulation);
        CHECK(record.state.t == static_cast<double>(k) / 25);
        double sum = 0;
        for (const StepReport& r : record.reports) {
            sum += r.h;
            sizes.insert(r.h);
            rejected += r.rejected;
        }
        CHECK(sum == Approx(1.0 / 25).epsilon(1e-12));
    }
    CHECK(rejected > 0);
    CHECK(sizes.size() >= 3);
    for (const double h : sizes) {
        const double halvings = std::log2(0.02 / h);
        CHECK(halvings == Approx(std::round(halvings)).margin(1e-9));
    }
}

TEST_CASE("accepted steps larger than the smallest raise strain by no more than asked") {
    Simulation simulation = start_simulation(adaptive_drape(0.02));
    double before = 0;
    for (int k = 0; k < 15; ++k) {
        for (const StepReport& r : next_record(simulation).reports) {
            if (r.h > 1.5 / 6400) CHECK(r.max_strain - std::max(before, 0.0) <= 0.02 + 1e-12);
            before = r.max_strain;
        }
    }
}

TEST_CASE("a rejected step leaves no trace: the run equals one made of its accepted steps alone") {
    Simulation simulation = start_simulation(adaptive_drape(0.02));
    std::vector<StepReport> reports = run_steps(simulation, 12);
    Simulation replay = start_simulation(adaptive_drape(0.02));
    std::uint32_t rejected = 0;
    for (const StepReport& r : reports) {
        rejected += r.rejected;
        guarded_step(replay.model, replay.options, r.h, replay.state, replay.ws, replay.guard);
        // Time is counted in halvings by the run, so that frames are met exactly.
        replay.state.t = r.t;
    }
    REQUIRE(rejected > 0);
    CHECK(state_hash(replay.state) == state_hash(simulation.state));
}

TEST_CASE("a step that never needs halving is the fixed step, bit for bit") {
    Scene fixed = drape();
    Scene adaptive = fixed;
    adaptive.solver.adaptive = AdaptiveStep{};
    adaptive.solver.adaptive->max_strain = 100;
    Simulation a = start_simulation(fixed), b = start_simulation(adaptive);
    run_steps(a, 6);
    run_steps(b, 6);
    CHECK(state_hash(a.state) == state_hash(b.state));
}
