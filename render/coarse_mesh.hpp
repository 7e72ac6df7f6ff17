#pragma once

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Triangles between about `count` of a mesh's particles, spread evenly along its edges, border first: each
/// other particle is stood for by the nearest of them, and triangles between three that differ remain. All of
/// the mesh's triangles where it has no more particles. The flat cloth and its uv play no part: a vertex that
/// is doubled there is one particle. Vertex indices, counter-clockwise as the mesh's own. O(particles).
std::vector<std::array<std::uint32_t, 3>> coarse_triangles(const ClothMesh& mesh, std::size_t count);

}  // namespace unravel::render
