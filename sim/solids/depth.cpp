#include "sim/solids/depth.hpp"

#include <algorithm>

namespace unravel::sim {

namespace {

// Distance to a solid as it is at the end of a step, or, for what keeps its shape, ever.
double distance_at(const Solid& solid, const DeformedSolid* deformed, const Vec3& x, double cutoff) {
    return nearest_surface(solid, deformed, true, x, cutoff).distance;
}

template <std::size_t N>
double least_on(const Solid& solid, const DeformedSolid* deformed, const std::array<Vec3, N>& corners,
                double precision, double& least) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : corners) middle += corner / static_cast<double>(N);
    double reach = 0;
    for (const Vec3& corner : corners) reach = std::max(reach, (corner - middle).norm());
    // Nothing here is nearer than this. What is outside altogether, or no deeper than is known, is passed
    // over.
    const double at = distance_at(solid, deformed, middle, reach);
    least = std::min(least, at);
    if (at - reach >= std::min(least, 0.0) || reach < precision) return least;
    const auto halfway = [&](std::size_t i, std::size_t j) { return Vec3(0.5 * (corners[i] + corners[j])); };
    if constexpr (N == 2) {
        least_on<2>(solid, deformed, {corners[0], middle}, precision, least);
        least_on<2>(solid, deformed, {middle, corners[1]}, precision, least);
    } else {
        const Vec3 ab = halfway(0, 1), bc = halfway(1, 2), ca = halfway(2, 0);
        least_on<3>(solid, deformed, {corners[0], ab, ca}, precision, least);
        least_on<3>(solid, deformed, {ab, corners[1], bc}, precision, least);
        least_on<3>(solid, deformed, {ca, bc, corners[2]}, precision, least);
        least_on<3>(solid, deformed, {ab, bc, ca}, precision, least);
    }
    return least;
}

}  // namespace

double least_on_edge(const Solid& solid, const DeformedSolid* deformed, const std::array<Vec3, 2>& corners,
                     double precision) {
    double least = std::min(distance_at(solid, deformed, corners[0], 0.0),
                            distance_at(solid, deformed, corners[1], 0.0));
    return least_on<2>(solid, deformed, corners, precision, least);
}

double least_on_triangle(const Solid& solid, const DeformedSolid* deformed,
                         const std::array<Vec3, 3>& corners, double precision) {
    double least = distance_at(solid, deformed, corners[0], 0.0);
    return least_on<3>(solid, deformed, corners, precision, least);
}

}  // namespace unravel::sim
