#include "sim/solids/sdf.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

using namespace unravel;
using namespace unravel::sim;

namespace {

std::vector<Solid> all_shapes() {
    std::vector<Solid> out(7);
    out[0].shape = Shape::plane;
    out[1].shape = Shape::sphere;
    out[2].shape = Shape::box;
    out[2].size = {0.6, 0.2, 0.9};
    out[3] = out[2];
    out[3].round = 0.05;
    out[4].shape = Shape::cylinder;
    out[4].height = 0.7;
    out[5] = out[4];
    out[5].round = 0.1;
    out[6].shape = Shape::capsule;
    out[6].height = 0.5;
    return out;
}

std::vector<Vec3> random_points(int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-0.8, 0.8);
    std::vector<Vec3> out;
    for (int i = 0; i < count; ++i)
        out.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    return out;
}

}  // namespace

TEST_CASE("signed distances are known at chosen points", "[solids]") {
    const std::vector<Solid> shapes = all_shapes();
    CHECK(signed_distance(shapes[0], {5, -0.3, 2}) == -0.3);
    CHECK(signed_distance(shapes[1], {0, 0.5, 0}) == Approx(0.2));
    CHECK(signed_distance(shapes[1], {0, 0, 0}) == -0.3);
    CHECK(signed_distance(shapes[2], {0, 0, 0}) == Approx(-0.1));
    CHECK(signed_distance(shapes[2], {0.3 + 0.03, 0.1 + 0.04, 0}) == Approx(0.05));
    // A rounded corner lies inside the sharp one by round (√3 − 1).
    CHECK(signed_distance(shapes[3], {0.3, 0.1, 0.45}) == Approx(0.05 * (std::sqrt(3.0) - 1)));
    CHECK(signed_distance(shapes[4], {0.3 + 0.03, 0.35 + 0.04, 0}) == Approx(0.05));
    CHECK(signed_distance(shapes[4], {0, 0.3, 0}) == Approx(-0.05));
    CHECK(signed_distance(shapes[5], {0.3, 0.35, 0}) == Approx(0.1 * (std::sqrt(2.0) - 1)));
    CHECK(signed_distance(shapes[6], {0, 0.25 + 0.4, 0}) == Approx(0.1));
    CHECK(signed_distance(shapes[6], {0.4, 0.1, 0}) == Approx(0.1));
}

TEST_CASE("the gradient is the slope of the distance, of unit length", "[solids]") {
    constexpr double h = 1e-6;
    for (const Solid& solid : all_shapes()) {
        int kinks = 0;
        for (const Vec3& p : random_points(2000)) {
            Vec3 gradient, slope;
            signed_distance(solid, p, &gradient);
            for (int axis = 0; axis < 3; ++axis) {
                const Vec3 step = h * Vec3::Unit(axis);
                slope[axis] = (signed_distance(solid, p + step) - signed_distance(solid, p - step)) / (2 * h);
            }
            CHECK(gradient.norm() == Approx(1).epsilon(1e-14));
            // Central differences err by h² over the distance to a centre of curvature squared, and by
            // rounding 1e-16/h; only within h of a middle plane is there no slope to compare with.
            if ((slope - gradient).norm() > 1e-8 / 0.01) ++kinks;
        }
        CHECK(kinks <= 1);
    }
}

TEST_CASE("the distance never changes by more than one moves", "[solids]") {
    const std::vector<Vec3> points = random_points(200);
    for (const Solid& solid : all_shapes()) {
        for (const Vec3& a : points) {
            for (const Vec3& b : points)
                REQUIRE(std::abs(signed_distance(solid, a) - signed_distance(solid, b)) <=
                        (a - b).norm() + 1e-15);
        }
    }
}

TEST_CASE("following the gradient by the distance reaches the surface", "[solids]") {
    for (const Solid& solid : all_shapes()) {
        for (const Vec3& p : random_points(500)) {
            Vec3 gradient;
            const double distance = signed_distance(solid, p, &gradient);
            REQUIRE(std::abs(signed_distance(solid, p - distance * gradient)) < 1e-14);
        }
    }
}

TEST_CASE("where no nearest point is unique the gradient is a unit vector, always the same", "[solids]") {
    const std::vector<Solid> shapes = all_shapes();
    const auto gradient_at = [&](std::size_t shape, const Vec3& p) {
        Vec3 gradient;
        CHECK(std::isfinite(signed_distance(shapes[shape], p, &gradient)));
        CHECK(gradient.norm() == Approx(1).epsilon(1e-14));
        return gradient;
    };
    CHECK(gradient_at(1, {0, 0, 0}) == Vec3(0, 1, 0));
    CHECK(gradient_at(2, {0, 0, 0}) == Vec3(0, 1, 0));    // the nearest faces, + side
    CHECK(gradient_at(4, {0, 0, 0}) == Vec3(1, 0, 0));    // the side
    CHECK(gradient_at(4, {0, 0.3, 0}) == Vec3(0, 1, 0));  // an end
    CHECK(gradient_at(6, {0, 0.1, 0}) == Vec3(1, 0, 0));
    for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
        // Edges, corners, denormal and huge offsets.
        gradient_at(shape, {0.3, 0.1, 0.45});
        gradient_at(shape, {0.3, 0.1, 0});
        gradient_at(shape, {0.3, 0.35, 0});
        gradient_at(shape, {0, 0.35, 0});
        gradient_at(shape, {std::numeric_limits<double>::denorm_min(), 0, 0});
        gradient_at(shape, {0, -1e-200, 1e-200});
        gradient_at(shape, {1e150, -1e150, 1e150});
    }
}
