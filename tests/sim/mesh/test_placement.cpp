#include "sim/mesh/placement.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace unravel;
using namespace unravel::sim;

TEST_CASE("an unrotated cloth lies flat, u along x, v along z, around its centre", "[scene]") {
    Cloth cloth;
    cloth.particles = {3, 5};
    cloth.size = {2, 4};
    cloth.placed_scale = {1.5, 1};
    cloth.center = {1, 2, 3};
    CHECK(placed_particle(cloth, 0, 0).isApprox(Vec3(1 - 1.5, 2, 3 - 2)));
    CHECK(placed_particle(cloth, 2, 4).isApprox(Vec3(1 + 1.5, 2, 3 + 2)));
    CHECK(placed_particle(cloth, 1, 2).isApprox(cloth.center));
}

TEST_CASE("rotations are about x, then y, then z", "[scene]") {
    // +z goes to −y (about x), stays (about y), goes to +x (about z).
    CHECK((rotation_matrix({90, 0, 90}) * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-15);
    CHECK((rotation_matrix({90, 90, 0}) * Vec3::UnitZ() + Vec3::UnitY()).norm() < 1e-15);
}

TEST_CASE("a tube has its circumference, its axis along v and no seam gap", "[scene]") {
    Cloth cloth;
    cloth.wrap = Wrap::tube;
    cloth.particles = {40, 3};
    cloth.size = {0.5, 0.8};
    const double chord = 0.5 / 40;
    const double radius = chord / (2 * std::sin(std::numbers::pi / 40));
    for (int i = 0; i < 40; ++i) {
        const Vec3 x = placed_particle(cloth, i, 0);
        CHECK(std::hypot(x.x(), x.y()) == Approx(radius));
        CHECK(x.z() == -0.4);
        CHECK((placed_particle(cloth, (i + 1) % 40, 0) - x).norm() == Approx(chord));
    }
}

TEST_CASE("all particles are placed as each is", "[scene]") {
    Cloth cloth;
    cloth.particles = {4, 3};
    cloth.rotation = {20, -30, 40};
    const std::vector<Vec3> all = placed_particles(cloth);
    REQUIRE(all.size() == 12);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i) CHECK(all[std::size_t(j * 4 + i)] == placed_particle(cloth, i, j));
}

TEST_CASE("pins catch the particles that they name", "[scene]") {
    Cloth cloth;
    cloth.particles = {5, 4};
    const auto caught = [&](Pin pin) { return pinned_particles(cloth, pin); };
    using Indices = std::vector<std::size_t>;
    Pin pin;
    pin.name = "u1v0";
    CHECK(caught(pin) == Indices{4});
    pin.name = "u0v1";
    CHECK(caught(pin) == Indices{15});
    pin.target = PinTarget::edge;
    pin.name = "u1";
    CHECK(caught(pin) == Indices{4, 9, 14, 19});
    pin.name = "v0";
    CHECK(caught(pin) == Indices{0, 1, 2, 3, 4});
    pin.target = PinTarget::particles;
    pin.range = {1, 2, 2, 3};
    CHECK(caught(pin) == Indices{11, 12, 16, 17});
    pin.target = PinTarget::box;
    pin.box = {{0.5, 0}, {1, 1.0 / 3}};  // both borders count
    CHECK(caught(pin) == Indices{2, 3, 4, 7, 8, 9});
    pin.target = PinTarget::disc;
    pin.disc = {{0, 0}, 0.34};  // spacing 1/4 along u, 1/3 along v
    CHECK(caught(pin) == Indices{0, 1, 5});
}

TEST_CASE("a disc on a tube reaches across the seam", "[scene]") {
    Cloth cloth;
    cloth.wrap = Wrap::tube;
    cloth.particles = {10, 1};
    Pin pin;
    pin.target = PinTarget::disc;
    pin.disc = {{0, 0.5}, 0.11};
    CHECK(pinned_particles(cloth, pin) == std::vector<std::size_t>{0, 1, 9});
}

TEST_CASE("a solid starts where its motion starts, turned about its pivot", "[scene]") {
    Solid solid;
    solid.center = {1, 0, 0};
    solid.pivot = {0, 0, 0};
    CHECK((start_pose(solid) * Vec3(0, 0, 0)).isApprox(Vec3(1, 0, 0)));
    solid.motion = {{1.0, Vec3(0, 0, 5), Vec3(0, 90, 0)}};
    CHECK((start_pose(solid) * Vec3(0, 0, 0)).isApprox(Vec3(0, 0, 4)));
}
