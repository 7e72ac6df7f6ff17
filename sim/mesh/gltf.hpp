#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "sim/mesh/figure.hpp"
#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// Reads a glTF 2.0 file, binary (.glb) or text with its data inside: the triangles of every mesh of its
/// scene where its nodes place them, as one mesh. Vertices that differ in nothing but normal, colour or
/// texture coordinates are one, for that is how the format writes borders of those. Objects are called as the
/// nodes and their meshes are, groups as the materials.
///
/// `animation`: the name of the one that is played; `figure` then gets what moves the mesh's vertices (of
/// the file), which stand as at its first moment. Empty: they stand as the nodes say, bent by their skins and
/// morph targets.
PolygonMesh parse_gltf(std::span<const std::uint8_t> bytes, const std::string& animation, MeshMessages& said,
                       std::shared_ptr<const Figure>& figure);

}  // namespace unravel::sim
