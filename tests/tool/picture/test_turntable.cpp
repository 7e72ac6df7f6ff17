#include "tool/picture/turntable.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/scenes.hpp"
#include "tool/picture/view.hpp"

using namespace unravel;
using namespace unravel::tool;

TEST_CASE("a_turntable_goes_once_round_a_frame_that_stands_still") {
    Scene scene = testing::drape(5);
    scene.cameras[0].position = {2, 1, 0};
    scene.cameras[0].target = {0, 0.5, 0};
    ClipOptions options;
    make_turntable(scene, options, 2, 10);
    CHECK(options.last == 49);
    CHECK(options.views[0].name == "textured_turntable");
    Simulation simulation = start_simulation(scene);
    const FrameSource source = turntable_source(options, present_record(simulation));
    int frames = 0;
    while (const auto record = source()) {
        CHECK(record->frame == frames++);
        CHECK(record->state.t == 0);
    }
    CHECK(frames == 50);
    const auto eye = [&](int frame) {
        return camera_at(scene, scene.cameras[0], frame_time(scene, frame)).position;
    };
    // Half way round it stands opposite; the first picture follows the last by one step.
    CHECK((eye(25) - Vec3f(-2, 1, 0)).norm() < 1e-5f);
    CHECK((eye(0) - eye(49)).norm() == Approx((eye(1) - eye(0)).norm()).epsilon(1e-3));
}
