// Physics that can be checked in closed form: friction on a slope, air, refinement, self-collision.

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/scene_file/presets.hpp"
#include "sim/self_collision/self_collision.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

constexpr double degree = std::numbers::pi / 180;

// A small sheet at rest on a slope of `angle` degrees; returns how far it slides down in `seconds`.
double slide(double angle, Friction friction, double seconds) {
    Scene scene;
    Cloth cloth = sheet(11, 0);
    cloth.size = {0.2, 0.2};
    cloth.rotation = {0, 0, -angle};
    Solid slope;
    slope.shape = Shape::plane;
    slope.rotation = {0, 0, -angle};
    slope.friction = friction;
    cloth.center = 0.004 * Vec3(std::sin(angle * degree), std::cos(angle * degree), 0);
    scene.cloths.push_back(cloth);
    scene.solids.push_back(slope);
    Simulation simulation = start_simulation(scene);
    const std::vector<Vec3> start = simulation.state.x;
    const int steps = static_cast<int>(std::lround(seconds * 400));
    for (int k = 0; k < steps; ++k)
        step(simulation.model, simulation.options, 1.0 / 400, simulation.state, simulation.ws);
    Vec3 moved = Vec3::Zero();
    for (std::size_t p = 0; p < start.size(); ++p)
        moved += (simulation.state.x[p] - start[p]) / static_cast<double>(start.size());
    return moved.dot(Vec3(std::cos(angle * degree), -std::sin(angle * degree), 0));
}

// How far a square metre of a material, held at two edges, sags on the average.
double sag(int n, const MaterialPreset& preset) {
    Scene scene;
    Cloth cloth = sheet(n, 0);
    cloth.material = preset.material;
    cloth.density = preset.density;
    for (const char* edge : {"u0", "u1"}) {
        Pin pin;
        pin.target = PinTarget::edge;
        pin.name = edge;
        cloth.pins.push_back(pin);
    }
    scene.cloths.push_back(cloth);
    scene.wind = Wind{};
    scene.wind->drag = 100;  // brings it to rest soon
    scene.solver.integrator = Integrator::implicit;
    scene.solver.tolerance = 1e-4;
    Simulation simulation = start_simulation(scene);
    for (int k = 0; k < 80; ++k)
        step(simulation.model, simulation.options, 0.02, simulation.state, simulation.ws);
    double depth = 0;
    for (std::size_t p = 0; p < simulation.model.size(); ++p)
        depth -= simulation.model.mass[p] * simulation.state.x[p].y() / preset.density;
    return depth;
}

}  // namespace

TEST_CASE("with friction 0.5 a sheet stays on a slope of 20 degrees") {
    CHECK(std::abs(slide(20, {0.5, 0.4}, 1.0)) < 1e-3);
}

TEST_CASE("on a slope of 30 degrees it slides with the acceleration that theory gives") {
    const double t = 0.5, mu = 0.4;
    const double acceleration = 9.81 * (std::sin(30 * degree) - mu * std::cos(30 * degree));
    // Friction needs the contact force of the step before: the first steps slide freely. 2% of the way.
    CHECK(slide(30, {0.5, mu}, t) == Approx(0.5 * acceleration * t * t).epsilon(0.02));
}

TEST_CASE("a falling sheet reaches the terminal speed of its drag") {
    Scene scene;
    scene.cloths.push_back(sheet(9, 0));
    scene.wind = Wind{};
    Simulation simulation = start_simulation(scene);
    for (int k = 0; k < 1600; ++k)
        step(simulation.model, simulation.options, 0.005, simulation.state, simulation.ws);
    // ½ ρ C v² = σ g per area
    const double terminal = std::sqrt(2 * 0.2 * 9.81 / 1.2);
    double speed = 0;
    for (std::size_t p = 0; p < simulation.model.size(); ++p) {
        speed -= simulation.model.mass[p] * simulation.state.v[p].y() / 0.2;
    }
    CHECK(speed == Approx(terminal).epsilon(0.01));
}

TEST_CASE("still air only takes energy, however dense it is") {
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.cloths.push_back(sheet(5, 0));
    scene.cloths[0].velocity = {0, -1, 0};
    scene.wind = Wind{};
    scene.wind->density = 1e6;
    Simulation simulation = start_simulation(scene);
    double energy = 0;
    for (std::size_t p = 0; p < simulation.model.size(); ++p) energy += 0.5 * simulation.model.mass[p];
    const double start = energy;
    for (int k = 0; k < 50; ++k) {
        const StepReport r =
            step(simulation.model, simulation.options, 0.005, simulation.state, simulation.ws);
        CHECK(r.kinetic + r.potential <= energy * (1 + 1e-9));
        energy = r.kinetic + r.potential;
    }
    CHECK(energy < 0.05 * start);
}

TEST_CASE("refining a cloth refines the same cloth: presets sag equally within 2 percent") {
    for (const MaterialPreset& preset : material_presets()) {
        INFO(preset.name);
        const double coarse = sag(25, preset), fine = sag(50, preset);
        INFO(coarse << ", " << fine << " m");
        CHECK(coarse > 0.01);
        CHECK(coarse == Approx(fine).epsilon(0.02));
    }
}

TEST_CASE("presets sag equally within 2 percent from 25 to 100 particles along each side", "[.long]") {
    for (const MaterialPreset& preset : material_presets()) {
        INFO(preset.name);
        CHECK(sag(25, preset) == Approx(sag(100, preset)).epsilon(0.02));
    }
}

TEST_CASE("masses add up to density times area, whatever the grid") {
    for (const std::array<int, 2> particles : {std::array{1, 1}, {1, 9}, {7, 3}, {40, 40}}) {
        Scene scene;
        scene.cloths.push_back(sheet(5, 0));
        scene.cloths[0].particles = particles;
        scene.cloths[0].size = {0.7, 1.3};
        Placement placement;
        const ClothModel model = build_model(scene, placement);
        double mass = 0;
        for (const double m : model.mass) mass += m;
        CHECK(mass == Approx(0.2 * 0.7 * 1.3).epsilon(1e-12));
    }
}

TEST_CASE("a tube starts unstretched and closes in u") {
    Scene scene;
    scene.cloths.push_back(sheet(5, 0));
    scene.cloths[0].particles = {12, 5};
    scene.cloths[0].wrap = Wrap::tube;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    CHECK(model.springs.stretch_count == 12u * 5 + 12 * 4);
    for (std::size_t s = 0; s < model.springs.stretch_count; ++s) {
        const double length = (placement.x[model.springs.j[s]] - placement.x[model.springs.i[s]]).norm();
        CHECK(length == Approx(model.springs.rest[s]).epsilon(1e-12));
    }
}

TEST_CASE("self-collision keeps two sheets apart, and without it they pass through each other") {
    const auto least = [](bool collide) {
        Scene scene;
        scene.cloths.push_back(sheet(15, 0.1));
        scene.cloths.push_back(sheet(15, 0.0));
        scene.cloths[1].center.x() = 0.03;
        Pin all;
        all.target = PinTarget::box;
        scene.cloths[1].pins.push_back(all);
        if (collide) {
            scene.self_collision = SelfCollision{};
            scene.self_collision->method = ContactMethod::particles;
        }
        Simulation simulation = start_simulation(scene);
        double distance = 1;
        for (int k = 0; k < 100; ++k) {
            step(simulation.model, simulation.options, 1.0 / 400, simulation.state, simulation.ws);
            for (std::uint32_t p = 0; p < 225; ++p) {
                for (std::uint32_t q = 225; q < 450; ++q) {
                    distance = std::min(distance, (simulation.state.x[p] - simulation.state.x[q]).norm());
                }
            }
        }
        return distance;
    };
    const double thickness = 0.75 / 14;
    CHECK(least(true) > 0.5 * thickness);
    CHECK(least(false) < 0.6 * thickness);
}

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs all_pairs(const ClothModel& model, const std::vector<Vec3>& x) {
    Pairs pairs;
    for (std::uint32_t p = 0; p < model.size(); ++p) {
        for (std::uint32_t q = p + 1; q < model.size(); ++q) {
            const bool near = (x[p] - x[q]).norm() < model.self_collision->thickness;
            if (near && !are_neighbours(model, p, q)) pairs.emplace_back(p, q);
        }
    }
    return pairs;
}

Pairs pairs_of(const SelfCollisionWorkspace& ws) {
    Pairs pairs;
    for (std::size_t s = 0; s < ws.springs.size(); ++s) pairs.emplace_back(ws.springs.i[s], ws.springs.j[s]);
    return pairs;
}

}  // namespace

TEST_CASE("colliding pairs are those of a search over all pairs") {
    Scene scene;
    scene.cloths.push_back(sheet(13, 0));
    scene.cloths[0].jitter = 0.3;
    scene.self_collision = SelfCollision{};
    scene.self_collision->method = ContactMethod::particles;
    scene.self_collision->thickness = 0.15;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    SelfCollisionWorkspace ws;
    self_collide(model, placement.x, placement.v, 0.005, 0.2, ws);
    CHECK(pairs_of(ws) == all_pairs(model, placement.x));
}

TEST_CASE(
    "they stay so while cloth flies, folds over and falls apart, and are looked for now and then only") {
    Scene scene;
    scene.cloths.push_back(sheet(25, 0));
    scene.cloths[0].jitter = 0.01;
    scene.self_collision = SelfCollision{};
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    SelfCollisionWorkspace ws;
    int searches = 0;
    std::size_t most = 0;
    for (int k = 0; k <= 120; ++k) {
        // Half of the sheet closes like a book, all of it flies 12 m, and at last it shrinks to a heap.
        const double angle = std::min(k / 80.0, 1.0) * 177 * degree,
                     share = k <= 80 ? 1 : 1 - (k - 80) / 50.0;
        std::vector<Vec3> x = placement.x;
        for (Vec3& at : x) {
            if (at.x() > 0) at = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * at;
            at = share * at + 0.1 * k * Vec3(1, -0.5, 0.2);
        }
        self_collide(model, x, placement.v, 0.005, 0.2, ws);
        searches += ws.x_searched == x;
        INFO(k);
        CHECK(pairs_of(ws) == all_pairs(model, x));
        most = std::max(most, ws.springs.size());
    }
    CHECK(most > 1000);
    CHECK(searches < 60);
}
