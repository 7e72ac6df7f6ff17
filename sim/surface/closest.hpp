#pragma once

#include <array>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Nearest points of the features of a surface (Ericson, "Real-Time Collision Detection", 2005, Sec. 5.1).
/// All are defined for features without extent too: a triangle of no area is its longest edge, an edge of no
/// length is a point.

/// Barycentric weights of the point of triangle abc nearest to p.
Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Share of the way from a to b at which the segment is nearest to p.
double closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// Shares (s, t) of the ways from a to b and from c to d at which two segments are nearest to each other. Of
/// parallel ones that are equally near along a stretch, the middle of it.
std::array<double, 2> closest_on_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Up to four particles and what each counts in the vector between two features,
///   r = Σ w_k x_k:  vertex–triangle (1, −α, −β, −γ),  edge–edge (1 − s, s, t − 1, −t).
using Weights = std::array<double, 4>;
Weights vertex_triangle_weights(const std::array<Vec3, 4>& x);
Weights edge_edge_weights(const std::array<Vec3, 4>& x);

inline Vec3 combined(const Weights& w, const std::array<Vec3, 4>& x) {
    return w[0] * x[0] + w[1] * x[1] + w[2] * x[2] + w[3] * x[3];
}

}  // namespace unravel::sim
