#pragma once

#include <span>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// A mesh's vertices for drawing: one for each smooth patch around a vertex of the mesh. Patches end at edges
/// that bend by more than 40 degrees, and where the surface does.
struct CreasedMesh {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices for drawing
    std::vector<std::uint32_t> source;                    ///< (vertices for drawing) vertex of the mesh
};
CreasedMesh crease(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const Vec3f> positions);

/// It with the mesh's vertices at `positions`; normals are smooth over each patch, weighted by area.
Tessellation tessellate_mesh(const CreasedMesh& mesh, std::span<const Vec3f> positions);

/// Square of half-width `reach` in the plane y = 0 facing +y, finer towards its middle.
Tessellation tessellate_ground(float reach);

}  // namespace unravel::render
