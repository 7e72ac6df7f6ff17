#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "sim/mesh/figure.hpp"
#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// Reads a mesh of the format that its file's name ends in: .obj, .ply, .stl, .glb or .gltf. A name that ends
/// in none is a fault. `animation` of a glTF file, and what it makes of the mesh (gltf.hpp).
PolygonMesh parse_mesh(const std::string& name, std::span<const std::uint8_t> bytes, MeshMessages& said,
                       const std::string& animation, std::shared_ptr<const Figure>& figure);

}  // namespace unravel::sim
