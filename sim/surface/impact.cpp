#include "sim/surface/impact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/surface/closest.hpp"

namespace unravel::sim {

namespace {

// Share of an advance that is made: at the end of a whole one nothing may be left.
constexpr double made_share = 0.9;
// Share of the distance beyond the gap that may be left where the advance ends.
constexpr double left_share = 0.1;
// Advances before what has been reached is taken for the answer: it is one, on the safe side.
constexpr int most_advances = 100;

// For how long the plane across the vector r between the nearest points keeps the features apart by more than
// `gap`, while all corners go straight. Endless where they don't approach it.
double separated(FeaturePair kind, const Vec3& r, double distance, const std::array<Vec3, 4>& x,
                 const std::array<Vec3, 4>& d, double gap) {
    const std::size_t cut = kind == FeaturePair::vertex_triangle ? 1 : 2;
    double longest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < cut; ++i) {
        for (std::size_t j = cut; j < 4; ++j) {
            const double closing = r.dot(d[j] - d[i]);
            if (closing <= 0) continue;
            longest = std::min(longest, (r.dot(x[i] - x[j]) - gap * distance) / closing);
        }
    }
    return std::max(longest, 0.0);
}

}  // namespace

std::array<double, 4> weights_of(FeaturePair kind, const std::array<Vec3, 4>& x) {
    return kind == FeaturePair::vertex_triangle ? vertex_triangle_weights(x) : edge_edge_weights(x);
}

bool stays_clear(FeaturePair kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d, double gap) {
    const bool vertex = kind == FeaturePair::vertex_triangle;
    const auto of_first = [&](const std::array<Vec3, 4>& y) {
        return vertex ? y[0] : Vec3(0.5 * (y[0] + y[1]));
    };
    const auto of_second = [&](const std::array<Vec3, 4>& y) {
        return vertex ? Vec3((y[1] + y[2] + y[3]) / 3) : Vec3(0.5 * (y[2] + y[3]));
    };
    const Vec3 one = of_first(x), other = of_second(x), ride = of_second(d);
    const std::size_t cut = vertex ? 1 : 2;
    double reach = gap;
    const auto add = [&](std::size_t first, std::size_t last, const Vec3& middle) {
        double farthest = 0, fastest = 0;
        for (std::size_t k = first; k < last; ++k) {
            farthest = std::max(farthest, (x[k] - middle).squaredNorm());
            fastest = std::max(fastest, (d[k] - ride).squaredNorm());
        }
        reach += std::sqrt(farthest) + std::sqrt(fastest);
    };
    add(0, cut, one);
    add(cut, 4, other);
    return (one - other).squaredNorm() > reach * reach;
}

double time_of_impact(FeaturePair kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d,
                      double gap) {
    std::array<Vec3, 4> at = x;
    double t = 0, enough = 0;
    for (int k = 0; k < most_advances; ++k) {
        const Vec3 r = combined(weights_of(kind, at), at);
        const double distance = r.norm(), room = distance - gap;
        if (k == 0) {
            if (d[0] == d[1] && d[0] == d[2] && d[0] == d[3]) return 1;
            enough = left_share * room;
        }
        if (room <= 0 || (k > 0 && room < enough)) return t;
        const double apart = separated(kind, r, distance, at, d, gap);
        if (t + apart >= 1) return 1;
        t += made_share * apart;
        for (std::size_t i = 0; i < 4; ++i) at[i] = x[i] + t * d[i];
    }
    return t;
}

}  // namespace unravel::sim
