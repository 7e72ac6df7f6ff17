#include "sim/surface/impact.hpp"

#include <algorithm>
#include <cmath>

#include "sim/surface/closest.hpp"

namespace unravel::sim {

namespace {

// Share of the distance beyond the gap that may be left where the advance ends.
constexpr double left_share = 0.1;
// Advances before what has been reached is taken for the answer: it is one, on the safe side.
constexpr int most_advances = 100;

double distance_of(FeaturePair kind, const std::array<Vec3, 4>& x) {
    return combined(weights_of(kind, x), x).norm();
}

// The fastest that any two points of the features approach, without the motion that all share. [m]
double closing_bound(FeaturePair kind, const std::array<Vec3, 4>& d) {
    const Vec3 mean = 0.25 * (d[0] + d[1] + d[2] + d[3]);
    const auto size = [&](std::size_t k) { return (d[k] - mean).norm(); };
    return kind == FeaturePair::vertex_triangle ? size(0) + std::max({size(1), size(2), size(3)})
                                                : std::max(size(0), size(1)) + std::max(size(2), size(3));
}

}  // namespace

std::array<double, 4> weights_of(FeaturePair kind, const std::array<Vec3, 4>& x) {
    return kind == FeaturePair::vertex_triangle ? vertex_triangle_weights(x) : edge_edge_weights(x);
}

double time_of_impact(FeaturePair kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d,
                      double gap) {
    const double closing = closing_bound(kind, d);
    if (closing == 0) return 1;
    double room = distance_of(kind, x) - gap;
    if (room > closing) return 1;
    if (room <= 0) return 0;
    const double enough = left_share * room;
    double t = (1 - left_share) * room / closing;
    for (int k = 0; k < most_advances && t < 1; ++k) {
        std::array<Vec3, 4> at;
        for (std::size_t i = 0; i < 4; ++i) at[i] = x[i] + t * d[i];
        room = distance_of(kind, at) - gap;
        if (room < enough) return t;
        t += (1 - left_share) * room / closing;
    }
    return std::min(t, 1.0);
}

}  // namespace unravel::sim
