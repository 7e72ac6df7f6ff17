#pragma once

#include <cstdint>
#include <span>

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// Reads an STL file, text or binary. It names every corner by its place: those of one and the same place, to
/// the last bit, are one vertex. Normals are passed over.
PolygonMesh parse_stl(std::span<const std::uint8_t> bytes, MeshMessages& said);

}  // namespace unravel::sim
