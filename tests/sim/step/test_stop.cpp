#include "base/stop.hpp"

#include <catch2/catch.hpp>

#include "sim/run/frame_record.hpp"
#include "sim/step/stage.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

constexpr double h = 1.0 / 400;
const std::atomic<int> asked{15};

// A taut sheet with the stop already asked for: it is entered as it is on the way through a step, and what it
// throws comes from within.
Simulation taut_and_asked() {
    Scene scene;
    scene.cloths.push_back(testing::sheet(24, 1));
    scene.cameras.emplace_back();
    Simulation s = start_simulation(scene);
    for (Vec3& x : s.state.x) x *= 1.2;
    s.options.solve.stop = &asked;
    return s;
}

}  // namespace

TEST_CASE("a stop is heard within an explicit step") {
    Simulation s = taut_and_asked();
    s.options.integrator = Integrator::explicit_;
    CHECK_THROWS_AS(swept_step(s.model, s.options, h, 4, s.state, s.ws), Stopped);
    s = taut_and_asked();
    s.options.integrator = Integrator::explicit_;
    CHECK_THROWS_AS(substeps_in_turn(s.model, s.options, h, 4, s.state, s.ws), Stopped);
}

TEST_CASE("a stop is heard within a linear solve") {
    for (const Preconditioner kind : {Preconditioner::constrained_block, Preconditioner::stencil_block,
                                      Preconditioner::multigrid, Preconditioner::ssor}) {
        INFO(static_cast<int>(kind));
        Simulation s = taut_and_asked();
        s.options.integrator = Integrator::implicit;
        s.options.solve.preconditioner = kind;
        CHECK_THROWS_AS(coupled_step(s.model, s.options, 4 * h, s.state, s.ws), Stopped);
    }
}

TEST_CASE("a stop that nobody asks for changes no bit") {
    Simulation plain = start_simulation(testing::drape(11)), watched = start_simulation(testing::drape(11));
    const std::atomic<int> quiet{0};
    watched.options.solve.stop = &quiet;
    testing::run_steps(plain, 3);
    testing::run_steps(watched, 3);
    CHECK(state_hash(plain.state) == state_hash(watched.state));
}
