// Pins over time: where their motion has them, and free from their release on.

#include <catch2/catch.hpp>

#include "sim/solids/motion.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

TEST_CASE("a keyframed pin has its particles where its motion has them, at every step") {
    Scene scene;
    scene.cloths.push_back(sheet(9, 1.0));
    Pin pin;
    pin.target = PinTarget::edge;
    pin.name = "u0";
    pin.motion = {{0.1, {0, 0, 0}, {0, 0, 0}}, {0.3, {0.1, 0.05, 0}, {0, 0, 40}}};
    scene.cloths[0].pins.push_back(pin);
    Simulation simulation = start_simulation(scene);
    const PinnedGroup& group = simulation.model.pins.at(0);
    REQUIRE(group.particles.size() == 9);
    for (int k = 1; k <= 100; ++k) {
        step(simulation.model, simulation.options, 0.004, simulation.state, simulation.ws);
        for (std::size_t p = 0; p < group.particles.size(); ++p) {
            const Vec3 due = moved_point(pin.motion, group.centre, group.start[p], simulation.state.t);
            CHECK((simulation.state.x[group.particles[p]] - due).norm() < 1e-12);
        }
    }
}

TEST_CASE("a released pin lets go at its time: from then on the particle falls freely") {
    Scene scene;
    Cloth cloth = sheet(1, 2.0);
    Pin pin;
    pin.target = PinTarget::particles;
    pin.range = {0, 0, 0, 0};
    pin.release = 0.2;
    cloth.pins.push_back(pin);
    scene.cloths.push_back(cloth);
    Simulation simulation = start_simulation(scene);
    const double h = 1.0 / 256;  // exact in binary
    for (int k = 1; k <= 128; ++k) {
        step(simulation.model, simulation.options, h, simulation.state, simulation.ws);
        const int held = 51;  // steps that end by 0.2 s
        const int free = std::max(0, k - held);
        CHECK(simulation.state.x[0].y() ==
              Approx(2.0 - 0.5 * 9.81 * h * h * free * (free + 1)).epsilon(1e-12));
    }
}
