// Forces gathered along rows against those evaluated spring by spring.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>

#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

// A crumpled sheet or tube in wind, of two materials, beside another.
Scene crumpled(int columns, int rows, Wrap wrap) {
    Scene scene;
    scene.name = "crumpled";
    for (int k = 0; k < 2; ++k) {
        Cloth cloth = sheet(columns, 1.0 + k);
        cloth.particles[1] = rows + 7 * k;
        cloth.wrap = wrap;
        cloth.material.bend = 1e-4;
        cloth.material.stretch_damping = {1e-2, 1e-2};
        cloth.jitter = 0.01;
        Region heavy;
        heavy.box = {{0.2, 0.3}, {0.6, 0.8}};
        heavy.density = 1.0;
        heavy.material = cloth.material;
        heavy.material->stretch = {20, 900};
        heavy.material->shear = 30;
        cloth.regions.push_back(heavy);
        Pin pin;
        pin.name = "v0";
        pin.target = PinTarget::edge;
        cloth.pins.push_back(pin);
        scene.cloths.push_back(cloth);
    }
    scene.wind = Wind{};
    scene.wind->velocity = {1, 0.5, 2};
    scene.wind->lift = 0.3;
    scene.clip.fps = 25;
    scene.cameras.emplace_back();
    return scene;
}

struct Difference {
    double force = 0;        // N, largest of all particles and steps
    double scale = 0;        // N, the largest force
    std::size_t states = 0;  // springs that are treated differently
};

// Each step is taken both ways from the same state.
Difference compare(const Scene& scene, const StepOptions& options, int steps) {
    Simulation rows = start_simulation(scene), springs = start_simulation(scene);
    StepOptions by_row = options, by_spring = options;
    by_spring.sweep = false;
    Difference out;
    for (int k = 0; k < steps; ++k) {
        springs.state = rows.state;
        step(rows.model, by_row, 0.005, rows.state, rows.ws);
        step(springs.model, by_spring, 0.005, springs.state, springs.ws);
        CHECK(rows.ws.plan.forces.by_rows);
        CHECK(!springs.ws.plan.forces.by_rows);
        for (std::size_t p = 0; p < rows.model.size(); ++p) {
            out.force = std::max(out.force,
                                 (rows.ws.linear.impulse[p] - springs.ws.linear.impulse[p]).norm() / 0.005);
            out.scale = std::max(out.scale, springs.ws.linear.impulse[p].norm() / 0.005);
        }
        for (std::size_t s = 0; s < rows.model.springs.size(); ++s)
            out.states += rows.ws.forces.memory.springs.state[s] != springs.ws.forces.memory.springs.state[s];
    }
    return out;
}

}  // namespace

TEST_CASE("forces gathered along rows are those of the springs", "[rows]") {
    for (const Wrap wrap : {Wrap::open, Wrap::tube}) {
        for (const auto& [columns, rows] : {std::pair{5, 3}, {9, 40}, {70, 21}}) {
            for (const Activation activation : {Activation::start, Activation::predicted}) {
                StepOptions options = step_options(Solver{});
                options.activation = activation;
                options.activation_band = activation == Activation::start ? 0.03 : 0.0;
                const Difference d = compare(crumpled(columns, rows, wrap), options, 8);
                INFO(columns << " x " << rows << (wrap == Wrap::tube ? ", tube" : ""));
                CHECK(d.force < 1e-11 * d.scale);
                CHECK(d.states == 0);
            }
        }
    }
}

TEST_CASE("forces gathered along rows are the same bits for any number of threads", "[rows]") {
    const auto hash_with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(static_cast<int>(threads));
        return arena.execute([] {
            Simulation s = start_simulation(crumpled(37, 90, Wrap::tube));
            for (int k = 0; k < 6; ++k) next_step(s);
            return state_hash(s.state);
        });
    };
    const std::uint64_t one = hash_with(1);
    CHECK(one == hash_with(2));
    CHECK(one == hash_with(5));
}
