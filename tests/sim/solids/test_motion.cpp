// Paths: how they are interpolated, how bodies fall and bounce, and what carries what.

#include "sim/solids/motion.hpp"

#include <catch2/catch.hpp>

#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

Motion path(Interpolation interpolation) {
    Motion motion{{0, {0, 0, 0}, {0, 0, 0}}, {1, {1, 0, 0}, {0, 0, 0}}, {3, {5, 0, 0}, {0, 0, 0}}};
    for (Keyframe& key : motion) key.interpolation = interpolation;
    return motion;
}

double x_at(const Motion& motion, double t) {
    return sample_motion(motion, t).displacement.x();
}

double height_at(const Solid& solid, double t) {
    return solid_pose(solid, t).translation().y();
}

}  // namespace

TEST_CASE("each interpolation goes from keyframe to keyframe its own way") {
    for (const Interpolation any :
         {Interpolation::smooth, Interpolation::linear, Interpolation::hold, Interpolation::ease}) {
        CHECK(x_at(path(any), 0) == 0);
        CHECK(x_at(path(any), 1) == Approx(1));
        CHECK(x_at(path(any), 3) == 5);
        CHECK(x_at(path(any), 9) == 5);
    }
    CHECK(x_at(path(Interpolation::linear), 0.25) == Approx(0.25));
    CHECK(x_at(path(Interpolation::linear), 2) == Approx(3));
    CHECK(x_at(path(Interpolation::hold), 0.999) == 0);
    CHECK(x_at(path(Interpolation::hold), 2.999) == 1);
    CHECK(x_at(path(Interpolation::ease), 0.25) == Approx(0.15625));  // 3/16 − 2/64
    // At rest in each keyframe, which the smooth one passes.
    const auto speed = [](Interpolation by) {
        return (x_at(path(by), 1 + 1e-6) - x_at(path(by), 1 - 1e-6)) / 2e-6;
    };
    CHECK(speed(Interpolation::ease) == Approx(0).margin(1e-5));
    CHECK(speed(Interpolation::smooth) > 1);
    // One keyframe may differ from the others of its path.
    Motion mixed = path(Interpolation::linear);
    mixed[1].interpolation = Interpolation::hold;
    CHECK(x_at(mixed, 0.5) == Approx(0.5));
    CHECK(x_at(mixed, 2.9) == Approx(1));
}

TEST_CASE("a ball falls as g says, bounces to the square of what it keeps, and comes to rest") {
    const Scene scene = parse_scene(
        "[cloth]\ncenter = [5, 5, 5]\n[[solid]]\nshape = \"sphere\"\nradius = 0.1\ncenter = [0, 1.1, 0]\n"
        "fall = { time = 0.5, floor = 0, bounce = 0.6, velocity = [2, 0, 0] }\n",
        "a.toml");
    const Solid& ball = scene.solids[0];
    CHECK(height_at(ball, 0.5) == 1.1);
    CHECK(height_at(ball, 0.7) == Approx(1.1 - 0.5 * 9.81 * 0.04));
    CHECK(solid_pose(ball, 0.7).translation().x() == Approx(0.4));
    const double hit = std::sqrt(2 / 9.81);  // from 1 m
    CHECK(height_at(ball, 0.5 + hit) == Approx(0.1));
    const double speed = 9.81 * hit;
    CHECK(height_at(ball, 0.5 + hit + 0.6 * speed / 9.81) == Approx(0.1 + 0.36));
    CHECK(solid_pose(ball, 0.5 + hit + 0.1).translation().x() == Approx(2 * hit + 0.6 * 2 * 0.1));
    for (double t = 0; t < 6; t += 0.01) CHECK(height_at(ball, t) > 0.1 - 1e-12);
    CHECK(height_at(ball, 6) == Approx(0.1));
    CHECK(solid_pose(ball, 6).translation() == solid_pose(ball, 7).translation());
}

TEST_CASE("a floor that gives is pushed in as far as it says, at a speed without jumps") {
    const Scene scene = parse_scene(
        "[cloth]\ncenter = [5, 5, 5]\n[[solid]]\nshape = \"sphere\"\nradius = 0.1\ncenter = [0, 1.1, 0]\n"
        "fall = { floor = 0, bounce = 0.8, give = 0.2 }\n",
        "a.toml");
    const Solid& ball = scene.solids[0];
    double lowest = 1, fastest = 0;
    for (int k = 1; k < 40000; ++k) {
        const double t = 1e-4 * k, before = height_at(ball, t - 1e-4), now = height_at(ball, t),
                     after = height_at(ball, t + 1e-4);
        lowest = std::min(lowest, now);
        // Not where it comes to rest, from below a millimetre.
        if (std::abs(now - 0.1) > 2e-3)
            fastest = std::max(fastest, std::abs(after - 2 * now + before) / 1e-8);
    }
    CHECK(lowest == Approx(-0.1).margin(1e-6));
    // At its greatest the floor pushes with v² / give; a jump of speed would show as 1e4 times it.
    CHECK(fastest < 1.01 * 2 * 9.81 / 0.2);
}

TEST_CASE("what rides on a body goes where it goes, and what rides on that goes along") {
    const Scene scene = parse_scene(
        "[cloth]\ncenter = [5, 5, 5]\n"
        "[[solid]]\nname = \"hand\"\nshape = \"sphere\"\nradius = 0.1\ncenter = [0, 1, 1]\nparent = \"arm\"\n"
        "[[solid]]\nname = \"arm\"\nshape = \"capsule\"\nradius = 0.1\nheight = 1\ncenter = [0, 1, "
        "0.5]\nparent = \"body\"\n"
        "pivot = [0, 1, 0]\nmotion = [{ time = 0 }, { time = 1, rotation = [-90, 0, 0] }]\n"
        "[[solid]]\nname = \"body\"\nshape = \"sphere\"\nradius = 0.2\ncenter = [0, 1, 0]\n"
        "motion = [{ time = 0 }, { time = 1, position = [2, 0, 0], rotation = [0, 90, 0] }]\n",
        "a.toml");
    const Solid& hand = scene.solids[0];
    CHECK((solid_pose(hand, 0).translation() - Vec3(0, 1, 1)).norm() < 1e-15);
    // The arm points up, whatever the body turns to.
    CHECK((solid_pose(hand, 1).translation() - Vec3(2, 2, 0)).norm() < 1e-12);
    CHECK(hand.moves());
    const Scene again = parse_scene(scene_to_toml(scene), "a.toml");
    CHECK(again.solids[0].parent == "arm");
    CHECK((solid_pose(again.solids[0], 0.3).translation() - solid_pose(hand, 0.3).translation()).norm() <
          1e-15);
}
