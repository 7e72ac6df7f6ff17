#pragma once

#include <cstdint>
#include <span>

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// Reads a PLY file (the Stanford polygon format 1.0), as text or binary of either byte order: positions,
/// faces of any number of corners, and texture coordinates of vertices (s t, u v or texture_u texture_v).
/// Other elements and properties are passed over. Faults have no lines.
PolygonMesh parse_ply(std::span<const std::uint8_t> bytes, MeshMessages& said);

}  // namespace unravel::sim
