#pragma once

#include <array>

#include "sim/scene/math.hpp"

namespace unravel::sim {

enum class FeaturePair { vertex_triangle, edge_edge };

/// Share of a straight motion, x + t d with t in [0, 1], up to which two features certainly stay farther
/// apart than `gap`; 1 where they do throughout. Conservative: advanced for as long as the plane across their
/// nearest points keeps them apart, until little is left (after Li, Kaufman & Jiang, "Codimensional
/// Incremental Potential Contact", 2021, Alg. 1, which advances by the distance over the fastest motion, and
/// creeps where layers slide along each other). Features that are not farther apart than `gap` to begin with
/// meet at 0 unless all of both moves alike.
///   x, d   vertex, then the triangle's corners; or the ends of one edge, then of the other [m]
double time_of_impact(FeaturePair kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d,
                      double gap);

/// Whether two features stay farther apart than `gap` for being small and their middles far apart: a quick
/// look that spares nearly all of those near each other along the cloth the nearest points.
bool stays_clear(FeaturePair kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d, double gap);

/// Weights of the nearest points (closest.hpp).
std::array<double, 4> weights_of(FeaturePair kind, const std::array<Vec3, 4>& x);

}  // namespace unravel::sim
