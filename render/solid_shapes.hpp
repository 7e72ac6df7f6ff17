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

/// A mesh with smooth normals.
Tessellation tessellate_mesh(std::span<const std::array<std::uint32_t, 3>> triangles,
                             std::span<const Vec3f> positions);

/// Square of half-width `reach` in the plane y = 0 facing +y, finer towards its middle.
Tessellation tessellate_ground(float reach);

}  // namespace unravel::render
