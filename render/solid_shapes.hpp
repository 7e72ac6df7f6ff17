#pragma once

#include <span>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Triangles of a solid in its own frame; counter-clockwise from outside.
struct Tessellation {
    std::vector<Vec3f> positions, normals;  ///< (vertices) [m], unit
    std::vector<std::uint32_t> indices;     ///< (triangles × 3)
};

/// Sphere, box (edges rounded by `round`), cylinder or capsule as SolidMesh describes them, fine enough that
/// their outline looks round at 1080p. A plane gives nothing: it is drawn as ground.
/// `detail` 1 is for the eye; less gives coarser, inscribed shapes.
Tessellation tessellate(const SolidMesh& solid, float detail = 1);

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
