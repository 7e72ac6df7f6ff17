#include "tool/picture/view.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/mesh/mesh_scene.hpp"
#include "tests/sim/scenes.hpp"
#include "tool/picture/subdivision.hpp"
#include "tool/picture/wire_colors.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

ClothPatch patch_of(int nu, int nv, bool tube) {
    ClothPatch patch;
    patch.particles = {nu, nv};
    patch.size = {1, 1};
    patch.tube = tube;
    return patch;
}

}  // namespace

TEST_CASE("subdivided_cloth_passes_through_its_particles_and_a_flat_one_stays_flat") {
    for (const bool tube : {false, true}) {
        const ClothPatch patch = patch_of(7, 5, tube);
        FineGrid grid(patch, 2);
        std::vector<Vec3f> particles, fine(grid.size());
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 7; ++i)
                particles.emplace_back(tube ? std::cos(i * 0.9f) : 0.3f * i, 0.1f * j,
                                       tube ? std::sin(i * 0.9f) : 0);
        grid.points(particles, fine);
        const auto at = [&](int i, int j) { return fine[static_cast<std::size_t>(j * grid.columns() + i)]; };
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 7; ++i) CHECK((at(4 * i, 4 * j) - particles[patch.at(i, j)]).norm() < 1e-6f);
        if (tube) continue;
        for (int j = 0; j < grid.rows(); ++j)
            for (int i = 0; i < grid.columns(); ++i)
                CHECK((at(i, j) - Vec3f(0.075f * i, 0.025f * j, 0)).norm() < 1e-6f);
    }
}

TEST_CASE("subdivision_rounds_a_tube") {
    // Sixteen particles around a circle: chords lie 1.9% inside it, the fine grid's points 0.1% at most.
    const ClothPatch patch = patch_of(16, 3, true);
    FineGrid grid(patch, 3);
    std::vector<Vec3f> particles, fine(grid.size());
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 16; ++i)
            particles.emplace_back(std::cos(i * 0.3926991f), 0.1f * j, std::sin(i * 0.3926991f));
    grid.points(particles, fine);
    for (const Vec3f& p : fine) CHECK(std::hypot(p.x(), p.z()) == Approx(1).margin(1e-3));
}

TEST_CASE("the_camera_passes_through_its_keyframes_without_a_jerk") {
    Scene scene = testing::drape();
    Camera& camera = scene.cameras[0];
    camera.keyframes = {{0, {0, 0, 2}, {0, 0, 0}}, {1, {2, 0, 2}, {0, 1, 0}}, {1.5, {2, 3, 2}, {0, 0, 0}}};
    for (const Camera::Key& key : camera.keyframes) {
        const CameraView view = camera_at(scene, camera, key.time);
        CHECK((view.position - key.position.cast<float>()).norm() < 1e-5f);
        CHECK((view.target - key.target.cast<float>()).norm() < 1e-5f);
    }
    // The speed just before the key in the middle is that just after it, and there is some.
    const double h = 1e-3;
    const auto speed = [&](double t) -> Vec3f {
        return (camera_at(scene, camera, t + h).position - camera_at(scene, camera, t).position) / h;
    };
    CHECK((speed(1 - h) - speed(1)).norm() < 0.1f);
    CHECK(speed(1).norm() > 1);
    CHECK(speed(0).norm() < 0.1f);
    CHECK(camera_at(scene, camera, 9).position == camera_at(scene, camera, 1.5).position);
}

TEST_CASE("a_camera_goes_along_with_what_it_follows") {
    Scene scene = testing::drape(5);
    Simulation simulation = start_simulation(scene);
    Placement placement;
    build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, simulation.model, placement);
    Camera& camera = scene.cameras[0];
    const CameraView still = camera_at(scene, camera, 0);
    camera.follow = "sphere";
    scene.solids[0].motion = {{0, {0, 0, 0}, {0, 0, 0}}, {1, {2, 0, 1}, {0, 90, 0}}};
    const CameraView ball = camera_at(scene, camera, 1);
    CHECK((ball.position - still.position - Vec3f(2, 0, 1)).norm() < 1e-5f);
    CHECK((ball.target - still.target - Vec3f(2, 0, 1)).norm() < 1e-5f);
    camera.follow = "sheet";
    std::vector<Vec3f> positions;
    for (const Vec3& x : placement.x) positions.push_back((x + Vec3(0.5, -1, 0)).cast<float>());
    const CameraView sheet = camera_of_frame(scene, camera, 1, simulation.model, positions, drawn);
    CHECK((sheet.position - still.position - Vec3f(0.5f, -1, 0)).norm() < 1e-5f);
    CHECK((sheet.target - still.target - Vec3f(0.5f, -1, 0)).norm() < 1e-5f);
}

TEST_CASE("exposures_lie_where_the_cloth_was_while_the_shutter_was_open") {
    Scene scene = testing::drape(5);
    scene.look.motion_blur = 4;
    scene.look.shutter = 0.5;
    Simulation simulation = start_simulation(scene);
    const FrameRecord before = present_record(simulation);
    // Free fall from rest over one frame: the cubic is exact.
    FrameRecord now = before;
    now.frame = 1;
    now.state.t = before.state.t + 0.04;
    for (std::size_t p = 0; p < now.state.x.size(); ++p) {
        now.state.x[p].y() -= 0.5 * 9.81 * 0.04 * 0.04;
        now.state.v[p].y() -= 9.81 * 0.04;
    }
    std::vector<DrawFrame> exposures;
    const std::vector<Rgb> colors(before.state.x.size());
    make_exposures(scene, simulation.model, now, &before.state, colors, 4, exposures);
    REQUIRE(exposures.size() == 4);
    const std::vector<double> times = exposure_times(scene, 1, 4);
    for (std::size_t e = 0; e < 4; ++e) {
        CHECK(times[e] == Approx(0.02 + 0.005 * (e + 0.5)));
        CHECK(exposures[e].positions[7].y() ==
              Approx(before.state.x[7].y() - 0.5 * 9.81 * times[e] * times[e]).margin(1e-6));
    }
    make_exposures(scene, simulation.model, before, nullptr, colors, 4, exposures);
    CHECK(exposures.size() == 1);
    // A frame that stands still has sharp exposures.
    make_exposures(scene, simulation.model, now, &now.state, colors, 4, exposures);
    CHECK(exposures[0].positions == exposures[3].positions);
}

TEST_CASE("wires_tell_the_splitting_strain_and_contact_of_their_springs") {
    Scene scene = testing::drape(5);
    Simulation simulation = start_simulation(scene);
    FrameRecord record = present_record(simulation);
    const std::vector<Rgb> components(simulation.model.size(), Rgb{1, 2, 3});
    record.springs[0] = SpringState::implicit;
    record.springs.back() = SpringState::explicit_;
    record.free[3] = 0;
    record.free[4] = 2;
    DrawFrame frame;
    const auto show = [&](Show what) {
        scene.look.show = what;
        color_wires(scene.look, simulation.model, record, components, frame);
    };
    show(Show::components);
    CHECK(frame.particle_colors == components);
    CHECK(frame.edge_colors.empty());
    CHECK(frame.edge_strength.size() == simulation.model.springs.stretch_count);
    CHECK(drawn_edges(simulation.model, Show::components).size() == frame.edge_strength.size());
    show(Show::splitting);
    CHECK(frame.edge_colors.size() == simulation.model.springs.size());
    CHECK(drawn_edges(simulation.model, Show::splitting).size() == frame.edge_colors.size());
    CHECK(frame.edge_colors.front() == implicit_color);
    CHECK(frame.edge_colors.back() == explicit_color);
    show(Show::contact);
    CHECK(frame.particle_colors[3] == Rgb{255, 255, 255});
    CHECK(frame.particle_colors[4] == partly_color);
    CHECK(frame.particle_colors[5] == free_color);
    // One spring pulled to the scale's end and beyond, its neighbours slack.
    for (Vec3& x : record.state.x) x *= 0.9;
    record.state.x[simulation.model.springs.i[0]] -= Vec3(0.3, 0, 0);
    show(Show::strain);
    CHECK(frame.edge_colors[0] == scale_color(1));
    CHECK(frame.edge_colors.back() == inactive_color);
}

TEST_CASE("a_picture_lies_on_a_mesh_by_its_texture_coordinates_and_once_on_a_grid") {
    // Two triangles whose coordinates go down to -1 and up to 2, and a square of a metre with none.
    const std::string placed =
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt -1 -1\nvt 2 -1\nvt 2 0.5\nvt -1 0.5\n"
        "f 1/1 4/4 3/3\nf 1/1 3/3 2/2\n";
    const std::string bare = "v -3 0 -3\nv -2 0 -3\nv -2 0 -2\nv -3 0 -2\nf 1 4 3\nf 1 3 2\n";
    const auto corners = [](const Scene& scene) {
        Placement placement;
        const ClothModel model = build_model(scene, placement);
        const ClothMesh mesh = make_draw_scene(scene, model, placement).cloths[0];
        Vec2f low = Vec2f::Constant(9), high = -low;
        for (const Vec2f& uv : mesh.uv) {
            low = low.cwiseMin(uv.cwiseProduct(mesh.picture_scale));
            high = high.cwiseMax(uv.cwiseProduct(mesh.picture_scale));
        }
        return std::array{low.x(), low.y(), high.x(), high.y()};
    };
    const std::string toml = "[cloth]\nmesh = \"mesh.obj\"\n";
    const auto near = [](float value) { return Approx(value).margin(1e-5); };
    const auto of_file = corners(testing::MeshScene(toml, placed).scene);
    CHECK(of_file[0] == near(-1));
    CHECK(of_file[1] == near(-1));
    CHECK(of_file[2] == near(2));
    CHECK(of_file[3] == near(0.5f));
    for (const auto& whole : {corners(testing::MeshScene(toml, bare).scene), corners(testing::drape(7))}) {
        CHECK(whole[0] == near(0));
        CHECK(whole[1] == near(0));
        CHECK(whole[2] == near(1));
        CHECK(whole[3] == near(1));
    }
}

TEST_CASE("the_bounds_of_a_clip_hold_where_pins_and_solids_go") {
    Scene scene = testing::drape(7);
    scene.clip.duration = 2;
    scene.solids[0].motion = {
        {0, {0, 0, 0}, {0, 0, 0}}, {1, {0, 0, 4}, {0, 0, 0}}, {2, {0, 0, 0}, {0, 0, 0}}};
    Pin pin;
    pin.name = "u0v0";
    pin.motion = {{0, {0, 0, 0}, {0, 0, 0}}, {2, {5, 0, 0}, {0, 0, 0}}};
    scene.cloths[0].pins.push_back(pin);
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    CHECK(drawn.bounds_high.x() == Approx(5.5).margin(0.05));
    CHECK(drawn.bounds_high.z() == Approx(4.3).margin(0.05));
    CHECK(drawn.bounds_low.x() == Approx(-0.5).margin(1e-6));
}
