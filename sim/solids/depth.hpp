#pragma once

#include <array>

#include "sim/solids/sdf.hpp"

namespace unravel::sim {

/// How deep the straight edge from a to b, or a triangle, goes into a solid: the least signed distance on it
/// [m], to within `precision`, or any bound above zero where all of it is outside. A distance changes no
/// faster than the place does, so what is farther from the solid than it reaches is passed over, and the rest
/// is halved until it is small.
///   corners   in the solid's own frame (sdf.hpp) [m]
double least_on_edge(const Solid& solid, const DeformedSolid* deformed, const std::array<Vec3, 2>& corners,
                     double precision);
double least_on_triangle(const Solid& solid, const DeformedSolid* deformed,
                         const std::array<Vec3, 3>& corners, double precision);

}  // namespace unravel::sim
