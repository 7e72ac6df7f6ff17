// Whole steps: what must hold whatever the scene.

#include <tbb/global_control.h>

#include <catch2/catch.hpp>

#include "sim/step/trace.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

TEST_CASE("one thread equals many, bit for bit") {
    const auto hash_with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        Simulation simulation = start_simulation(drape(41));
        std::vector<std::uint64_t> hashes;
        for (int k = 0; k < 8; ++k) hashes.push_back(state_hash(next_record(simulation).state));
        return hashes;
    };
    const std::vector<std::uint64_t> one = hash_with(1);
    CHECK(one == hash_with(2));
    CHECK(one == hash_with(7));
}

TEST_CASE("at every step the decomposed solution meets the whole system's tolerance") {
    Scene scene = drape();
    Simulation simulation = start_simulation(scene);
    int decomposed_steps = 0;
    for (int k = 0; k < 200; ++k) {
        step(simulation.model, simulation.options, 0.005, simulation.state, simulation.ws);
        const StepTrace trace = trace_of(simulation.model, simulation.ws);
        decomposed_steps += trace.components.count() > 1;
        // The very same system undecomposed: residual of the decomposed solution in the stopping rule's norm.
        Components whole;
        whole_cloth(simulation.model.size(), whole);
        System system, parts;
        assemble(trace.couplings, trace.load, whole, trace.constraints, 0.005, system);
        assemble(trace.couplings, trace.load, trace.components, trace.constraints, 0.005, parts);
        BlockPreconditioner P;
        build_preconditioner(Preconditioner::constrained_block, system, whole, trace.constraints, P);
        double residual = 0, right = 0;
        for (std::uint32_t p = 0; p < simulation.model.size(); ++p) {
            const Vec3 r = system.b[p] - row_times(system, p, trace.dv);
            residual += r.dot(P.inverse[p] * r);
            // Neighbours that are held are part of a component's right-hand side.
            const Vec3& b = parts.b[parts.row_of[p]];
            right += b.dot(P.inverse[p] * b);
        }
        CHECK(std::sqrt(residual) <= 1.0001 * scene.solver.tolerance * std::sqrt(right));
    }
    CHECK(decomposed_steps > 50);
}

TEST_CASE("decomposing changes the motion by no more than the tolerance") {
    Scene scene = drape();
    scene.solver.tolerance = 1e-9;
    Simulation parts = start_simulation(scene);
    scene.solver.decompose = false;
    Simulation whole = start_simulation(scene);
    for (int k = 0; k < 30; ++k) {
        step(parts.model, parts.options, 0.005, parts.state, parts.ws);
        step(whole.model, whole.options, 0.005, whole.state, whole.ws);
    }
    double most = 0;
    for (std::size_t p = 0; p < parts.state.x.size(); ++p) {
        most = std::max(most, (parts.state.x[p] - whole.state.x[p]).norm());
    }
    CHECK(most < 1e-6);
}

TEST_CASE("free fall without air is exact, and momentum is gravity's alone") {
    Scene scene;
    scene.cloths.push_back(sheet(9, 1.0));
    scene.cloths.back().velocity = {0.3, 0.1, -0.2};
    scene.cameras.emplace_back();
    Simulation simulation = start_simulation(scene);
    const std::vector<Vec3> start = simulation.state.x;
    const int steps = 40;
    const double h = 0.005;
    for (int k = 0; k < steps; ++k)
        step(simulation.model, simulation.options, h, simulation.state, simulation.ws);
    // Symplectic Euler's fall: Σ k g h² = g h² n (n + 1)/2.
    const Vec3 fallen =
        steps * h * Vec3(0.3, 0.1, -0.2) + 0.5 * steps * (steps + 1) * h * h * Vec3(0, -9.81, 0);
    for (std::size_t p = 0; p < start.size(); ++p) {
        CHECK((simulation.state.x[p] - start[p] - fallen).norm() < 1e-10);
    }
}

TEST_CASE("internal forces sum to zero: momentum of a jittered sheet is kept without gravity") {
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.cloths.push_back(sheet(11, 1.0));
    scene.cloths.back().placed_scale = {1.1, 0.9};
    scene.cloths.back().jitter = 0.01;
    scene.solver.tolerance = 1e-12;
    Simulation simulation = start_simulation(scene);
    for (int k = 0; k < 50; ++k)
        step(simulation.model, simulation.options, 0.005, simulation.state, simulation.ws);
    Vec3 momentum = Vec3::Zero();
    double scale = 0;
    for (std::size_t p = 0; p < simulation.model.size(); ++p) {
        momentum += simulation.model.mass[p] * simulation.state.v[p];
        scale += simulation.model.mass[p] * simulation.state.v[p].norm();
    }
    REQUIRE(scale > 1e-3);
    CHECK(momentum.norm() < 1e-9 * scale);
}

TEST_CASE("cloth stays outside the sphere and the ground, pins stay where they are put") {
    Scene scene = drape();
    Solid ground;
    ground.shape = Shape::plane;
    scene.solids.push_back(ground);
    Pin pin;
    pin.name = "u0v0";
    scene.cloths[0].pins.push_back(pin);
    Simulation simulation = start_simulation(scene);
    const std::uint32_t pinned = simulation.model.pins.at(0).particles.at(0);
    const Vec3 place = simulation.state.x[pinned];
    for (int k = 0; k < 250; ++k) {
        step(simulation.model, simulation.options, 0.005, simulation.state, simulation.ws);
        for (const Vec3& x : simulation.state.x) {
            CHECK((x - Vec3(0, 0.6, 0)).norm() >= 0.3);
            CHECK(x.y() >= 0);
        }
        CHECK((simulation.state.x[pinned] - place).norm() < 1e-13);
    }
}

TEST_CASE("a record brings a simulation back to the same bits") {
    Simulation first = start_simulation(drape());
    run_steps(first, 5);
    const FrameRecord record = next_record(first);
    run_steps(first, 5);
    Simulation second = start_simulation(drape());
    restore(second, record);
    run_steps(second, 5);
    CHECK(state_hash(first.state) == state_hash(second.state));
    CHECK(first.state.t == second.state.t);
}

TEST_CASE("frame k is reached at exactly k over the frame rate") {
    Scene scene = drape(5);
    scene.clip.fps = 30;
    scene.solver.step = 1.0 / 240;
    Simulation simulation = start_simulation(scene);
    for (int k = 1; k <= 90; ++k) CHECK(next_record(simulation).state.t == static_cast<double>(k) / 30);
}

TEST_CASE("effects that the scene does not name hold no memory and take no time") {
    Scene scene;
    scene.cloths.push_back(sheet(11, 1.0));
    scene.cloths[0].material.bend = 0;
    Simulation simulation = start_simulation(scene);
    const std::vector<StepReport> reports = run_steps(simulation, 4);
    const ClothModel& model = simulation.model;
    const StepWorkspace& ws = simulation.ws;
    const ForceMemory& forces = ws.forces.memory;
    const std::pair<const char*, std::size_t> held[] = {
        {"air", forces.air.cells.corners.capacity() + forces.air.cells.start.capacity() +
                    forces.air.cells.cells.capacity()},
        {"air forces", forces.air.force.capacity()},
        {"pins", model.pins.capacity()},
        {"solids", model.solids.capacity()},
        {"poses", ws.contact.poses.now.capacity() + ws.contact.poses.next.capacity()},
        {"touches", ws.contact.touches.capacity() + ws.contact.found.capacity()},
        {"inertia", ws.contact.inertia.capacity()},
        {"reactions", ws.contact.reactions.impulse.capacity()},
        {"contacts", simulation.state.contacts.capacity()},
        {"bends", model.bends.i.capacity() + model.bends.stiffness.bytes() + forces.bending.force.capacity()},
        {"self-collision",
         forces.self_collision.springs.i.capacity() + forces.self_collision.forces.force.capacity() +
             forces.self_collision.adjacency.start.capacity() + forces.self_collision.x_searched.capacity() +
             forces.self_collision.pairs.capacity() + forces.self_collision.voxel_start.capacity() +
             forces.self_collision.found.capacity()},
        {"comparison", ws.whole.system.entries.capacity() + ws.whole.solves.capacity()},
        {"multistep", simulation.state.x_previous.capacity() + simulation.state.v_previous.capacity()},
    };
    for (const auto& [effect, count] : held) {
        INFO(effect);
        CHECK(count == 0);
    }
    for (const StepReport& r : reports) {
        CHECK(r.times.air == 0);
        CHECK(r.times.collision == 0);
        CHECK(r.times.contact == 0);
        CHECK(r.times.compare == 0);
    }
}

TEST_CASE("effects that cannot act change no bit") {
    Scene scene;
    scene.cloths.push_back(sheet(11, 1.0));
    scene.cloths[0].placed_scale = {1.05, 0.97};  // so that there is something to compute
    const auto hash = [](const Scene& s) {
        Simulation simulation = start_simulation(s);
        run_steps(simulation, 5);
        return state_hash(simulation.state);
    };
    const std::uint64_t alone = hash(scene);
    const auto with = [&](const char* what, const auto& change) {
        Scene changed = scene;
        change(changed);
        INFO(what);
        CHECK(hash(changed) == alone);
    };
    with("a solid out of reach", [](Scene& s) {
        Solid sphere;
        sphere.center = sphere.pivot = {100, 0, 0};
        sphere.motion = {{0.0, {0, 0, 0}, {0, 0, 0}}, {1.0, {0, 1, 0}, {0, 90, 0}}};
        s.solids.push_back(sphere);
    });
    with("self-collision of a flat cloth", [](Scene& s) { s.self_collision = SelfCollision{}; });
    with("air of no density", [](Scene& s) {
        s.wind = Wind{};
        s.wind->density = 0;
    });
    with("air of no drag and no lift, gusting", [](Scene& s) {
        s.wind = Wind{};
        s.wind->drag = 0;
        s.wind->velocity = {5, 0, 0};
        s.wind->gust = Gust{};
    });
    with("a region of the cloth's own material and density", [](Scene& s) {
        Region region;
        region.box = {{0, 0}, {0.5, 1}};
        region.material = s.cloths[0].material;
        region.density = s.cloths[0].density;
        s.cloths[0].regions.push_back(region);
    });
    with("a pin that has let go at the start", [](Scene& s) {
        Pin pin;
        pin.target = PinTarget::edge;
        pin.name = "v0";
        pin.release = 0;
        s.cloths[0].pins.push_back(pin);
    });
    with("an adaptive step that finds nothing to halve", [](Scene& s) {
        s.solver.adaptive = AdaptiveStep{};
        s.solver.adaptive->max_strain = 10;
    });

    // Gusts of no strength, and keyframes of the same wind, are that wind.
    scene.wind = Wind{};
    scene.wind->velocity = {3, 0, 1};
    const std::uint64_t windy = hash(scene);
    CHECK(windy != alone);
    Scene gusting = scene;
    gusting.wind->gust = Gust{0, 0.5, 7};
    CHECK(hash(gusting) == windy);
    Scene keyframed = scene;
    keyframed.wind->keyframes = {{0.0, {3, 0, 1}}, {2.0, {3, 0, 1}}};
    keyframed.wind->velocity = {0, 0, 0};
    CHECK(hash(keyframed) == windy);
}
