// Bend springs against the circular arc that they stand for.

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/forces/bend.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// The arc exactly: θ with sin θ/θ = s by bisection, then F = θ²/(cos θ − sin θ/θ).
double theta_of(double s) {
    double low = 1e-9, high = std::numbers::pi;
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (std::sin(middle) / middle > s ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

TEST_CASE("arc force is within its stated error of the exact arc for every length") {
    for (int k = 0; k <= 900; ++k) {
        const double s = k / 1000.0, theta = theta_of(s);
        const double exact = theta * theta / (std::cos(theta) - std::sin(theta) / theta);
        CHECK(std::abs(arc_force(s) / exact - 1) < 4e-5);
    }
    // Near s = 1 the exact expression cancels; its limit and first order are known: F = −3 − 9/5 (1 − s) + …
    CHECK(arc_force(1.0) == Approx(-3.0).epsilon(4e-5));
    CHECK(arc_force(0.99) == Approx(-3.0 - 1.8 * 0.01).epsilon(2e-4));
    CHECK(arc_force(0.0) == Approx(-std::numbers::pi * std::numbers::pi).epsilon(4e-5));
    CHECK(std::isfinite(arc_force(-1.0)));
}

TEST_CASE("arc energy is the square of the arc's half angle") {
    for (int k = 0; k <= 950; ++k) {
        const double s = k / 1000.0, theta = theta_of(s);
        CHECK(arc_energy(s) == Approx(theta * theta).epsilon(4e-5));
    }
    CHECK(arc_energy(1.0) == 0.0);
}

TEST_CASE("bend force is minus the gradient of its energy, across the crossing of the two pushes") {
    const double rest = 0.04, stiffness = 6e-8, slope = 0.6;
    const double crossing = bend_crossing(rest, stiffness, slope);
    REQUIRE(crossing > 0.5 * rest);
    REQUIRE(crossing < rest);
    const double d = 1e-7 * rest;
    for (int k = 1; k < 200; ++k) {
        const double length = rest * k / 200.0;
        if (std::abs(length - crossing) < 2 * d) continue;
        const double slope_of_energy = (bend_energy(length + d, rest, stiffness, slope, crossing) -
                                        bend_energy(length - d, rest, stiffness, slope, crossing)) /
                                       (2 * d);
        // Along û on i, shortening's push is negative: f = dE/dl.
        CHECK(bend_force(length, rest, stiffness, slope) == Approx(slope_of_energy).epsilon(1e-5));
    }
    CHECK(bend_force(rest, rest, stiffness, slope) == 0.0);
    CHECK(bend_force(1.5 * rest, rest, stiffness, slope) == 0.0);
    CHECK(bend_energy(rest, rest, stiffness, slope, crossing) == 0.0);
}

TEST_CASE("of the two pushes the weaker acts, and they agree where they cross") {
    const double rest = 0.04, stiffness = 6e-8, slope = 0.6;
    const double crossing = bend_crossing(rest, stiffness, slope);
    CHECK(bend_force(crossing, rest, stiffness, slope) == Approx(slope * (crossing - rest)).epsilon(1e-12));
    for (int k = 0; k < 100; ++k) {
        const double length = rest * k / 100.0;
        const double arc = 4 * stiffness / (rest * rest) * arc_force(length / rest),
                     linear = slope * (length - rest);
        CHECK(bend_force(length, rest, stiffness, slope) == std::max(arc, linear));
    }
    // A slope too weak for the arc is the weaker one everywhere.
    CHECK(bend_crossing(rest, stiffness, 1e-9) == 0.0);
}

TEST_CASE("an explicit bend spring's slope never exceeds what the step bears") {
    BendSprings springs;
    springs.i = {0, 1};
    springs.j = {1, 2};
    springs.rest = {0.04, 0.04};
    springs.stiffness = {6e-8, 6e-8};
    springs.slope = {0.6, 0.6};
    const std::vector<double> mass{1e-4, 1e-4, 1e-6};
    BendLimit limit;
    limit_bend(springs, mass, 0.005, limit);
    CHECK(limit.slope[0] == 0.6);
    CHECK(limit.slope[1] == Approx(bend_slope_limit * 1e-6 / (0.005 * 0.005)));
    CHECK(limit.limited == 1);
    CHECK(limit.crossing[1] == bend_crossing(0.04, 6e-8, limit.slope[1]));
}

TEST_CASE("bend forces push coincident ends nowhere, and are finite at every length") {
    BendSprings springs;
    springs.i = {0};
    springs.j = {1};
    springs.rest = {0.04};
    springs.stiffness = {6e-8};
    springs.slope = {0.6};
    const std::vector<double> mass{1e-4, 1e-4};
    BendLimit limit;
    limit_bend(springs, mass, 0.001, limit);
    std::vector<Vec3> force(1);
    for (const double length : {0.0, 1e-300, 1e-12, 0.02, 0.04}) {
        const std::vector<Vec3> x{{0, 0, 0}, {0, length, 0}};
        bend_forces(springs, limit, x, force);
        CHECK(force[0].allFinite());
        CHECK(force[0].y() <= 0);
    }
}

TEST_CASE("bend force's slope is its derivative on either side of the crossing and never negative") {
    const double rest = 0.04, stiffness = 6e-8, slope = 0.6;
    const double crossing = bend_crossing(rest, stiffness, slope), d = 1e-6 * rest;
    for (int k = 1; k < 200; ++k) {
        const double length = rest * k / 200.0;
        if (std::abs(length - crossing) < 2 * d) continue;
        const double difference = (bend_force(length + d, rest, stiffness, slope) -
                                   bend_force(length - d, rest, stiffness, slope)) /
                                  (2 * d);
        CHECK(bend_force_slope(length, rest, stiffness, slope) == Approx(difference).epsilon(1e-4));
        CHECK(bend_force_slope(length, rest, stiffness, slope) >= 0);
    }
    CHECK(bend_force_slope(rest, rest, stiffness, slope) == 0);
}
