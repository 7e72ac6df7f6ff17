// Nearest points of triangles and edges against samples of them, their degenerate cases, and times of impact
// against motions of known outcome and against fine steps in time.

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/surface/closest.hpp"
#include "sim/surface/impact.hpp"
#include "tests/sim/surface/random_surface.hpp"

using namespace unravel::sim;
using namespace unravel::testing;

namespace {

constexpr int samples = 60;

double sampled_distance_to_triangle(const std::array<Vec3, 4>& x) {
    double least = 1e9;
    for (int i = 0; i <= samples; ++i) {
        for (int j = 0; i + j <= samples; ++j) {
            const double a = double(i) / samples, b = double(j) / samples;
            least = std::min(least, (x[0] - (a * x[1] + b * x[2] + (1 - a - b) * x[3])).norm());
        }
    }
    return least;
}

double sampled_distance_of_edges(const std::array<Vec3, 4>& x) {
    double least = 1e9;
    for (int i = 0; i <= samples; ++i) {
        for (int j = 0; j <= samples; ++j) {
            const double s = double(i) / samples, t = double(j) / samples;
            least = std::min(least, ((1 - s) * x[0] + s * x[1] - (1 - t) * x[2] - t * x[3]).norm());
        }
    }
    return least;
}

double distance(FeaturePair kind, const std::array<Vec3, 4>& x) {
    return combined(weights_of(kind, x), x).norm();
}

double longest(const std::array<Vec3, 4>& x) {
    double most = 0;
    for (const Vec3& a : x) {
        for (const Vec3& b : x) most = std::max(most, (a - b).norm());
    }
    return most;
}

}  // namespace

TEST_CASE("no point of a triangle or of two edges is nearer than the nearest", "[surface]") {
    std::mt19937 random(1);
    for (int k = 0; k < 400; ++k) {
        std::array<Vec3, 4> x;
        for (Vec3& p : x) p = random_vector(random, 1);
        // Every third has edges that are nearly parallel, and a triangle that is nearly a line.
        if (k % 3 == 0) x[3] = x[2] + (1 + 0.1 * (k % 7)) * (x[1] - x[0]) + random_vector(random, 1e-9);
        const double off = longest(x) / samples;
        const double triangle = distance(FeaturePair::vertex_triangle, x),
                     edges = distance(FeaturePair::edge_edge, x);
        CHECK(triangle <= sampled_distance_to_triangle(x) + 1e-8);
        CHECK(triangle >= sampled_distance_to_triangle(x) - off);
        CHECK(edges <= sampled_distance_of_edges(x) + 1e-8);
        CHECK(edges >= sampled_distance_of_edges(x) - off);
        for (const FeaturePair kind : {FeaturePair::vertex_triangle, FeaturePair::edge_edge}) {
            const Weights w = weights_of(kind, x);
            CHECK(std::abs(w[0] + w[1] + w[2] + w[3]) < 1e-12);
        }
    }
}

TEST_CASE("features without extent have nearest points too", "[surface]") {
    const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.3, 0, 0), p(0.5, 2, 0);
    const Vec3 line = closest_on_triangle(p, a, b, c);
    CHECK((line[0] * a + line[1] * b + line[2] * c - Vec3(0.5, 0, 0)).norm() < 1e-12);
    const Vec3 point = closest_on_triangle(p, a, a, a);
    CHECK(point.sum() == Approx(1));
    CHECK(closest_on_segments(a, a, p, p) == std::array<double, 2>{0.0, 0.0});
    CHECK(closest_on_segments(a, b, p, p)[0] == Approx(0.5));
    CHECK(closest_on_segments(p, p, a, b)[1] == Approx(0.5));
    // Parallel edges beside each other meet in the middle of the stretch that they share; others at ends.
    const auto [s, t] = closest_on_segments(a, b, {0.5, 1, 0}, {2.5, 1, 0});
    CHECK(s == Approx(0.75));
    CHECK(t == Approx(0.125));
    const auto [end, begin] = closest_on_segments(a, b, {2, 1, 0}, {3, 1, 0});
    CHECK(end == 1.0);
    CHECK(begin == 0.0);
}

TEST_CASE("a vertex falling onto a triangle stops at the gap, whatever both share of motion", "[surface]") {
    const std::array<Vec3, 4> x{Vec3(0.2, 1, 0.2), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
    std::array<Vec3, 4> d{Vec3(0, -2, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
    // Meets at t = 0.5; at the gap of 0.1 at 0.45.
    for (const Vec3& ride : {Vec3(0, 0, 0), Vec3(30, -50, 10)}) {
        std::array<Vec3, 4> moving = d;
        for (Vec3& v : moving) v += ride;
        const double t = time_of_impact(FeaturePair::vertex_triangle, x, moving, 0.1);
        CHECK(t <= 0.45);
        CHECK(t >= 0.45 - 0.1 * 0.9 / 2 - 1e-9);  // a tenth of the room may be left
    }
    d[0] = {0, -0.85, 0};
    CHECK(time_of_impact(FeaturePair::vertex_triangle, x, d, 0.1) == 1.0);
    CHECK(time_of_impact(FeaturePair::vertex_triangle, x, d, 1.0) == 0.0);
}

TEST_CASE("up to the time of impact features are apart in every instant", "[surface]") {
    std::mt19937 random(2);
    int impacts = 0, early = 0;
    for (int k = 0; k < 600; ++k) {
        std::array<Vec3, 4> x, d;
        for (std::size_t i = 0; i < 4; ++i) {
            x[i] = random_vector(random, 1);
            d[i] = random_vector(random, 2);
        }
        for (const FeaturePair kind : {FeaturePair::vertex_triangle, FeaturePair::edge_edge}) {
            const double gap = 0.2 * distance(kind, x);
            const double t = time_of_impact(kind, x, d, gap);
            impacts += t < 1;
            double least = 1e9;
            for (int s = 0; s <= 200; ++s) {
                std::array<Vec3, 4> at;
                for (std::size_t i = 0; i < 4; ++i) at[i] = x[i] + t * s / 200 * d[i];
                least = std::min(least, distance(kind, at));
            }
            CHECK(least >= gap);
            early += t < 1 && least > gap + 0.11 * (distance(kind, x) - gap);
        }
    }
    CHECK(impacts > 100);
    // Where it stops short of the end, it does so near the gap; but for few that pass by each other closely.
    CHECK(early < impacts / 50);
}
