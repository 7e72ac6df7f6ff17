// Air on a cell in closed form, and winds that change.

#include "sim/forces/air.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unravel;
using namespace unravel::sim;

TEST_CASE("drag acts along a cell's normal, lift along the cell") {
    AirCells air;
    air.corners = {{0, 1, 2, 3}};
    connect_cells(4, air);
    const double side = 0.1;
    const std::vector<Vec3> x{{0, 0, 0}, {0, 0, side}, {side, 0, side}, {side, 0, 0}}, v(4, Vec3(0, 0.5, 0));
    const std::vector<double> mass(4, 10.0);  // heavy: no bound on what the cell can bear
    Wind wind;
    wind.velocity = {3, 2.5, 0};
    wind.drag = 1.1;
    wind.lift = 0.3;
    std::vector<Vec3> force(1);
    air_forces(air, wind, 0, 0.001, mass, x, v, force);
    const double half = 0.5 * 1.2 * side * side;
    CHECK(force[0].y() == Approx(half * 1.1 * 2 * 2));
    CHECK(force[0].x() == Approx(half * 0.3 * std::sqrt(13.0) * 3));
    CHECK(std::abs(force[0].z()) < 1e-15);
    // The same from below: drag always goes with the wind.
    wind.velocity = {3, -1.5, 0};
    air_forces(air, wind, 0, 0.001, mass, x, v, force);
    CHECK(force[0].y() == Approx(-half * 1.1 * 2 * 2));
}

TEST_CASE("a gust is a smooth function of its seed, with the deviation that it says") {
    Wind wind;
    wind.velocity = {4, 0, 0};
    wind.gust = Gust{0.35, 0.7, 5};
    Wind other = wind;
    other.gust->seed = 6;
    double mean = 0, square = 0, different = 0, jump = 0, before = wind_velocity(wind, 0).x();
    const int n = 200000;
    const double dt = 0.01;
    for (int k = 0; k < n; ++k) {
        const double speed = wind_velocity(wind, k * dt).x();
        CHECK(speed == wind_velocity(wind, k * dt).x());
        mean += speed / n;
        square += speed * speed / n;
        different = std::max(different, std::abs(speed - wind_velocity(other, k * dt).x()));
        jump = std::max(jump, std::abs(speed - before));
        before = speed;
    }
    CHECK(mean == Approx(4).epsilon(0.02));
    CHECK(std::sqrt(square - mean * mean) == Approx(0.35 * 4).epsilon(0.05));
    CHECK(different > 1);
    // From one extreme to the other within a period at the steepest of the cubic, 1.5 times the mean slope.
    CHECK(jump < 2 * std::sqrt(3.0) * std::sqrt(35.0 / 26.0) * 0.35 * 4 * 1.5 * dt / 0.7 * 1.001);
}

TEST_CASE("a keyframed wind meets its keyframes, is straight between and steady outside") {
    Wind wind;
    wind.velocity = {9, 9, 9};
    wind.keyframes = {{1.0, {0, 0, 0}}, {2.0, {4, 0, 2}}, {4.0, {0, 0, -2}}};
    CHECK(wind_velocity(wind, 0).isZero());
    CHECK(wind_velocity(wind, 1).isZero());
    CHECK((wind_velocity(wind, 1.25) - Vec3(1, 0, 0.5)).norm() < 1e-15);
    CHECK(wind_velocity(wind, 2) == Vec3(4, 0, 2));
    CHECK((wind_velocity(wind, 3) - Vec3(2, 0, 0)).norm() < 1e-15);
    CHECK(wind_velocity(wind, 10) == Vec3(0, 0, -2));
}
