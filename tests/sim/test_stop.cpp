#include "base/stop.hpp"

#include <catch2/catch.hpp>

#include "sim/run/frame_record.hpp"
#include "sim/step/stage.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// A step of a taut sheet, entered as it is on the way through one, with the stop already asked for: what it
// throws comes from within.
void take_step(Integrator integrator, Preconditioner preconditioner, bool sweep) {
    Scene scene;
    scene.cloths.push_back(testing::sheet(24, 1));
    scene.cameras.emplace_back();
    Simulation s = start_simulation(scene);
    for (Vec3& x : s.state.x) x *= 1.2;
    const std::atomic<int> asked{15};
    s.options.integrator = integrator;
    s.options.solve.preconditioner = preconditioner;
    s.options.solve.stop = &asked;
    s.options.sweep = sweep;
    s.options.substeps = 4;
    if (integrator == Integrator::explicit_) {
        explicit_step(s.model, s.options, 1.0 / 400, s.state, s.ws);
    } else {
        coupled_step(s.model, s.options, 1.0 / 100, s.state, s.ws);
    }
}

}  // namespace

TEST_CASE("a stop is heard within a step") {
    const auto any = Preconditioner::constrained_block;
    CHECK_THROWS_AS(take_step(Integrator::explicit_, any, true), Stopped);
    CHECK_THROWS_AS(take_step(Integrator::explicit_, any, false), Stopped);
    for (const Preconditioner kind : {Preconditioner::constrained_block, Preconditioner::stencil_block,
                                      Preconditioner::multigrid, Preconditioner::ssor})
        CHECK_THROWS_AS(take_step(Integrator::implicit, kind, true), Stopped);
}

TEST_CASE("without one nothing changes") {
    Simulation plain = start_simulation(testing::drape(11)), watched = start_simulation(testing::drape(11));
    const std::atomic<int> quiet{0};
    watched.options.solve.stop = &quiet;
    testing::run_steps(plain, 3);
    testing::run_steps(watched, 3);
    CHECK(state_hash(plain.state) == state_hash(watched.state));
}
