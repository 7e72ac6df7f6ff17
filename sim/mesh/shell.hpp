#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/mesh/polygon_mesh.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

using Triangle = std::array<std::uint32_t, 3>;

/// A surface as a closed body: its triangles of `vertices` vertices, the same the other way round of vertices
/// after those, and two along every edge of its border.
std::vector<Triangle> shell_triangles(std::span<const Triangle> surface, std::size_t vertices);

/// Moves the vertices of a surface out by half of the thickness, along its normals there (weighted by area),
/// and appends those of its other side, as far in. (vertices) becomes (2 vertices) [m]
void thicken(std::span<const Triangle> surface, double thickness, std::vector<Vec3>& x);

}  // namespace unravel::sim
