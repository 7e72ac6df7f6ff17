// The explicit sweep against the general path, which treats every spring by itself.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>

#include "sim/step/choose_integrator.hpp"
#include "sim/step/explicit_limit.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

// A sheet that swings from a corner that is carried along, in wind, over another of other cells.
Scene swinging(int n) {
    Scene scene;
    scene.name = "swinging";
    for (int k = 0; k < 2; ++k) {
        scene.cloths.push_back(sheet(n + 3 * k, 1.0 + k));
        scene.cloths.back().particles[1] = n - 2;
    }
    Pin carried;
    carried.name = "u0v0";
    carried.motion = {{0, {0, 0, 0}, {0, 0, 0}}, {0.5, {0.1, 0.05, 0}, {0, 30, 0}}};
    scene.cloths[0].pins.push_back(carried);
    Pin released;
    released.name = "u1v1";
    released.release = 0.02;
    scene.cloths[1].pins.push_back(released);
    scene.wind = Wind{};
    scene.wind->velocity = {1, 0, 2};
    scene.wind->lift = 0.2;
    scene.clip.fps = 25;
    scene.cameras.emplace_back();
    return scene;
}

double difference(const ClothState& a, const ClothState& b) {
    double most = 0;
    for (std::size_t p = 0; p < a.x.size(); ++p) most = std::max(most, (a.x[p] - b.x[p]).norm());
    return most;
}

// Steps both ways from the same start and tells the largest distance between them [m].
double sweep_error(Scene scene, int substeps, int steps) {
    scene.solver.integrator = Integrator::explicit_;
    scene.solver.substeps = substeps;
    Simulation swept = start_simulation(scene), in_turn = start_simulation(scene);
    in_turn.options.sweep = false;
    double most = 0;
    for (int k = 0; k < steps; ++k) {
        const StepReport a = step(swept.model, swept.options, 0.004, swept.state, swept.ws);
        const StepReport b = step(in_turn.model, in_turn.options, 0.004, in_turn.state, in_turn.ws);
        most = std::max(most, difference(swept.state, in_turn.state));
        CHECK(a.constrained == b.constrained);
        CHECK(a.contacts == b.contacts);
        CHECK(a.partly == b.partly);
        CHECK(a.kinetic == Approx(b.kinetic).epsilon(1e-7));
        CHECK(a.potential == Approx(b.potential).epsilon(1e-7));
    }
    return most;
}

}  // namespace

TEST_CASE("the explicit sweep gives what stepping spring by spring gives", "[sweep]") {
    CHECK(sweep_error(swinging(14), 13, 12) < 1e-10);
    Scene bent = swinging(9);  // folded enough for the arc's push
    bent.cloths[0].material.bend = bent.cloths[1].material.bend = 1e-4;
    bent.cloths[0].jitter = 0.02;
    CHECK(sweep_error(bent, 10, 12) < 1e-10);
    Scene tube = swinging(12);
    tube.cloths[0].wrap = Wrap::tube;
    CHECK(sweep_error(tube, 12, 10) < 1e-10);
}

TEST_CASE("contact within the explicit sweep is that of the general path", "[sweep]") {
    Scene scene = drape(23);
    scene.cloths[0].center = {0, 0.91, 0};
    scene.cloths[0].velocity = {0, -1, 0};
    Solid moving = scene.solids.front();
    moving.name = "moving";
    moving.shape = Shape::box;
    moving.contact = SolidContact::particles;  // edges and faces are for the general path alone
    moving.size = {0.2, 0.2, 0.2};
    moving.center = moving.pivot = {0.4, 0.7, 0.1};
    moving.motion = {{0, {0, 0, 0}, {0, 0, 0}}, {0.1, {0, 0.1, 0}, {20, 0, 40}}};
    scene.solids.push_back(moving);
    CHECK(sweep_error(scene, 12, 25) < 1e-9);
}

TEST_CASE("the explicit sweep gives the same bits for any number of threads", "[sweep]") {
    const auto hash_with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(static_cast<int>(threads));
        return arena.execute([] {
            Scene scene = drape(70);
            scene.cloths[0].center = {0, 0.91, 0};
            scene.solver.integrator = Integrator::explicit_;
            scene.solver.substeps = 0;
            Simulation s = start_simulation(scene);
            for (int k = 0; k < 6; ++k) next_step(s);
            return state_hash(s.state);
        });
    };
    const std::uint64_t one = hash_with(1);
    CHECK(one == hash_with(2));
    CHECK(one == hash_with(5));
}

TEST_CASE("explicit steps divide themselves until they are stable", "[sweep]") {
    Scene scene = swinging(20);
    scene.solver.integrator = Integrator::explicit_;
    Simulation s = start_simulation(scene);
    CHECK_THROWS_AS(require_explicit_stability(s.model, s.options, 0.04), UnstableStep);
    s.options.substeps = 0;
    require_explicit_stability(s.model, s.options, 0.04);
    for (int k = 0; k < 10; ++k) {
        const StepReport report = step(s.model, s.options, 0.04, s.state, s.ws);
        CHECK(report.substeps > 1);
        CHECK(report.max_strain < 0.5);
    }
}

TEST_CASE(
    "auto takes explicit substeps for soft cloth, adaptive IMEX for stiff, and says the same when asked "
    "again",
    "[sweep]") {
    Scene scene = swinging(20);
    scene.solver.integrator = Integrator::automatic;
    Simulation soft = start_simulation(scene);
    CHECK(step(soft.model, soft.options, 0.005, soft.state, soft.ws).implicit == 0);
    for (Cloth& cloth : scene.cloths) cloth.material.stretch = {1e8, 1e8};
    Simulation stiff = start_simulation(scene);
    CHECK(step(stiff.model, stiff.options, 0.04, stiff.state, stiff.ws).implicit > 0);
    StepWorkspace fresh;
    CHECK(plan_step(stiff.model, stiff.options, 0.04, fresh).integrator == Integrator::adaptive_imex);
    fresh = {};
    CHECK(plan_step(soft.model, soft.options, 0.005, fresh).integrator == Integrator::explicit_);
}

TEST_CASE("auto counts the contact that every substep looks into", "[sweep]") {
    Scene scene = swinging(20);
    scene.solids.clear();
    const Simulation in_air = start_simulation(scene);
    scene.solids.emplace_back().shape = Shape::sphere;
    const Simulation beside_ball = start_simulation(scene);
    const auto costs = [](const Simulation& s, double h) {
        PlanMemory fresh;
        return count_costs(s.model, s.options, h, fresh);
    };
    double h = 1e-4;
    while (costs(in_air, h).substeps < 10) h *= 1.3;
    CHECK(costs(beside_ball, h).substeps == costs(in_air, h).substeps);
    CHECK(costs(in_air, h).cheaper() == Integrator::explicit_);
    CHECK(costs(beside_ball, h).cheaper() == Integrator::adaptive_imex);
}

TEST_CASE("a solid that the cloth can't come to changes nothing that auto chooses by", "[sweep]") {
    Scene scene = swinging(20);
    scene.solids.clear();
    const auto costs = [&] {
        const Simulation simulation = start_simulation(scene);
        PlanMemory fresh;
        const IntegratorCosts counted = count_costs(simulation.model, simulation.options, 1e-3, fresh);
        return std::pair(counted.explicit_cost, counted.coupled_cost);
    };
    const auto in_air = costs();
    Solid& ball = scene.solids.emplace_back();
    ball.shape = Shape::sphere;
    ball.center = ball.pivot = {0, 0, 1000};
    CHECK(costs() == in_air);
    ball.motion = {{0, {0, 0, 0}, {0, 0, 0}}, {0.5, {0, 5, 0}, {0, 30, 0}}};
    CHECK(costs() == in_air);
    // On its way here it is counted.
    ball.motion.back().position = {0, 0, -1000};
    CHECK(costs() != in_air);
    ball.motion.clear();
    ball.fall.emplace().velocity = {0, 0, -2000};
    CHECK(costs() != in_air);
    // So is a floor, however deep, under what falls on and on.
    ball = {};
    ball.shape = Shape::plane;
    ball.center = {0, -20, 0};
    scene.clip.duration = 10;
    CHECK(costs() != in_air);
}
