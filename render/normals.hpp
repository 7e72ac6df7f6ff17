#pragma once

#include <span>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Smooth unit normals of a mesh's particles: triangle normals weighted by area, summed over the triangles
/// around a particle, so that both sides of a tube's seam agree. A particle with no area around it gets (0,
/// 1, 0).
///   mesh       triangles counter-clockwise from the front: normals point to the front
///   positions  (particles) [m]
///   normals    (particles) overwritten for the mesh's particles, others left as they are
void smooth_normals(const ClothMesh& mesh, std::span<const Vec3f> positions, std::span<Vec3f> normals);

}  // namespace unravel::render
