// Pins that ride, slide and gather, in every way of stepping; and the time before frame 0.

#include <catch2/catch.hpp>

#include "sim/constraints/pins.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/scene_file/load.hpp"
#include "source_dir.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

// The swept and the general explicit steps, and an implicit one.
const std::vector<std::string> ways{"explicit", "adaptive-imex"};

Scene scene_of(const std::string& text, const std::string& integrator) {
    return parse_scene(text, "a.toml", ".",
                       {"solver.integrator=" + integrator,
                        "solver.substeps=" + std::string(integrator == "explicit" ? "0" : "1")});
}

const std::string small_cloth =
    "[clip]\nfps = 50\nduration = 1\n[cloth]\nparticles = [13, 9]\nsize = [0.6, 0.4]\nfacing = \"front\"\n"
    "center = [0, 1.5, 0.3]\nmaterial = { stretch = 60, shear = 5, stretch_damping = 0.02 }\n";

}  // namespace

TEST_CASE("a pin rides on a solid that moves and turns, exactly, however it is stepped") {
    for (const std::string& way : ways) {
        INFO(way);
        const Scene scene = scene_of(
            small_cloth +
                "[[cloth.pin]]\nedge = \"v0\"\ncount = 4\nto = \"body\"\n"
                "[[solid]]\nname = \"body\"\nshape = \"capsule\"\nradius = 0.1\nheight = 0.4\ncenter = [0, "
                "1.4, 0]\n"
                "motion = [{ time = 0 }, { time = 0.6, position = [0.5, 0.1, 0], rotation = [0, 60, 0] }]\n",
            way);
        Simulation simulation = start_simulation(scene);
        const PinnedGroup& group = simulation.model.pins.at(0);
        REQUIRE(group.particles == std::vector<std::uint32_t>{0, 4, 8, 12});
        for (int frame = 1; frame <= 30; ++frame) {
            next_record(simulation);
            const double t = simulation.state.t;
            const Pose gone =
                solid_pose(scene.solids[0], t) * solid_pose(scene.solids[0], 0).inverse(Eigen::Isometry);
            for (std::size_t k = 0; k < 4; ++k)
                CHECK((simulation.state.x[group.particles[k]] - gone * group.start[k]).norm() < 1e-12);
        }
        CHECK((simulation.state.x[0] - group.start[0]).norm() > 0.3);
    }
}

TEST_CASE("a pin rides on the surface of a body that deforms") {
    const Scene scene = parse_scene(
        "[clip]\nfps = 20\n[cloth]\nparticles = [5, 3]\nsize = [0.3, 0.2]\ncenter = [0, 3, 0]\n"
        "[[cloth.pin]]\nedge = \"v0\"\nto = \"body\"\n"
        "[[solid]]\nname = \"body\"\nshape = \"mesh\"\nmesh = \"tetra.obj\"\nmesh_frames = "
        "\"tetra_##.obj\"\nmesh_fps = 2\n",
        "a.toml", UNRAVEL_SOURCE_DIR "/tests/scenes");
    Simulation simulation = start_simulation(scene);
    const PinnedGroup& group = simulation.model.pins.at(0);
    REQUIRE(group.triangles.size() == 5);
    const MeshSolid& body = *scene.solids[0].geometry;
    std::vector<Vec3> now;
    for (int frame = 1; frame <= 10; ++frame) {
        next_record(simulation);
        body.positions_at(simulation.state.t, now);
        for (std::size_t k = 0; k < 5; ++k) {
            // As far from the first corner of its triangle, and from its plane, as at the start.
            const auto& corners = body.triangles[static_cast<std::size_t>(group.triangles[k])];
            const auto normal = [&](const std::vector<Vec3>& x) {
                return Vec3(
                    (x[corners[1]] - x[corners[0]]).cross(x[corners[2]] - x[corners[0]]).normalized());
            };
            const Vec3 at = simulation.state.x[group.particles[k]] - now[corners[0]];
            const Vec3 before = group.start[k] - body.rest[corners[0]];
            CHECK(at.norm() == Approx(before.norm()).epsilon(1e-9));
            CHECK(at.dot(normal(now)) == Approx(before.dot(normal(body.rest))).margin(1e-9));
        }
    }
}

TEST_CASE("rings slide down a rod without friction as a bead does, and stop at its end") {
    for (const std::string& way : ways) {
        INFO(way);
        const Scene scene = scene_of(
            "[clip]\nfps = 50\nduration = 1\n[cloth]\nparticles = [1, 1]\nsize = [0.01, 0.01]\ncenter = [0, "
            "2, 0]\n"
            "[[cloth.pin]]\ncorner = \"u0v0\"\nrod = \"rod\"\n"
            "[[solid]]\nname = \"rod\"\nshape = \"cylinder\"\nradius = 0.01\nheight = 2\ncenter = [0, 1.97, "
            "0]\n"
            "rotation = [0, 0, -60]\n",
            way);
        Simulation simulation = start_simulation(scene);
        const Vec3 along = simulation.model.pins.at(0).slide;  // upwards, 60 degrees off
        const double h = 1.0 / (50 * simulation.steps_per_frame), a = 9.81 * 0.5;
        while (simulation.state.t < 0.4) next_step(simulation);
        const Vec3 off = simulation.state.x[0] - Vec3(0, 2, 0);
        CHECK((off - along * along.dot(off)).norm() < 1e-12);
        // Both schemes are of first order: half a step's speed ahead, or behind.
        CHECK(-along.dot(off) == Approx(0.5 * a * 0.16).margin(a * 0.4 * h));
        while (simulation.state.t < 1) next_step(simulation);
        const double reached = along.dot(simulation.state.x[0] - simulation.model.pins[0].rod);
        CHECK(reached == Approx(-1).margin(a * h * h));
    }
}

TEST_CASE("pins that slide move across their line with their motion, and let the cloth move along it") {
    const Scene scene = parse_scene(
        small_cloth +
            "[[cloth.pin]]\ncorner = \"u0v0\"\n[[cloth.pin]]\ncorner = \"u1v0\"\nmotion = [{ time = 0 }, { "
            "time = 0.5, position = [-0.3, 0, 0] }]\n[[cloth.pin]]\nedge = \"v0\"\nslide = [2, 0, 0]\n",
        "a.toml");
    Simulation simulation = start_simulation(scene);
    const std::vector<Vec3> start = simulation.state.x;
    run_steps(simulation, 40);
    double moved = 0;
    for (std::size_t p = 0; p < 13; ++p) {
        const Vec3 off = simulation.state.x[p] - start[p];
        CHECK(std::hypot(off.y(), off.z()) < 1e-12);
        moved = std::max(moved, std::abs(off.x()));
    }
    CHECK(moved == Approx(0.3));
    CHECK(present_record(simulation).free[5] == 1);
}

TEST_CASE("a row of hooks is gathered to its width in its time, also while the scene settles") {
    for (const double settle : {0.0, 0.5}) {
        INFO(settle);
        const Scene scene = parse_scene(
            small_cloth + "[[cloth.pin]]\nedge = \"v0\"\ncount = 5\ngather = 0.3\ngather_time = 0.4\n",
            "a.toml", ".", {"clip.settle=" + std::to_string(settle)});
        Simulation simulation = start_simulation(scene);
        const std::vector<std::uint32_t> hooks = simulation.model.pins.at(0).particles;
        REQUIRE(hooks.size() == 5);
        const auto width = [&] {
            return simulation.state.x[hooks.back()].x() - simulation.state.x[hooks.front()].x();
        };
        CHECK(width() == Approx(0.6));
        if (settle == 0)
            run_steps(simulation, 20);
        else
            REQUIRE(sim::settle(simulation));
        CHECK(width() == Approx(0.3));
    }
}

TEST_CASE("a scene settles before frame 0 while nothing moves, and its clock starts after that") {
    const std::string text =
        small_cloth +
        "[[cloth.pin]]\nedge = \"v0\"\nmotion = [{ time = 0 }, { time = 0.2, position = [0, 0, 0.2] }]\n";
    const Scene plain = parse_scene(text, "a.toml"),
                settling = parse_scene(text, "a.toml", ".", {"clip.settle=0.6"});
    Simulation simulation = start_simulation(settling);
    CHECK(simulation.state.t == Approx(-0.6));
    CHECK(next_step(simulation).t < 0);
    REQUIRE(settle(simulation));
    CHECK(simulation.state.t == 0);
    const PinnedGroup& group = simulation.model.pins[0];
    for (std::size_t k = 0; k < group.particles.size(); ++k)
        CHECK((simulation.state.x[group.particles[k]] - group.start[k]).norm() < 1e-12);
    // It has sagged.
    CHECK(simulation.state.x.back().y() < start_simulation(plain).state.x.back().y() - 1e-4);
    const FrameRecord first = next_record(simulation);
    CHECK(first.frame == 1);
    CHECK(first.state.t == 1.0 / 50);
    // Stopped on the way it can go on.
    Simulation stopped = start_simulation(settling);
    int steps = 0;
    CHECK(!settle(stopped, [&] { return ++steps < 10; }));
    REQUIRE(settle(stopped));
    CHECK(next_record(stopped).state.x == first.state.x);
    // Who forgets to settle it gets to the same frame.
    Simulation forgetful = start_simulation(settling);
    CHECK(next_record(forgetful).state.x == first.state.x);
}
