#pragma once

#include <functional>

#include "render/draw_scene.hpp"
#include "render/framebuffer.hpp"

namespace unravel::render {

/// Calls `visit` with points whose convex hull holds all cloths and solids of a frame: every particle, and
/// eight corners around each solid. Planes have no end and are left out.
/// A `visit` by reference (std::ref) allocates nothing, whatever it captures.
void visit_bounds(const DrawScene& scene, const DrawFrame& frame,
                  const std::function<void(const Vec3f&)>& visit);

/// A box along the axes [m].
struct BoundingBox {
    Vec3f low, high;
    Vec3f centre() const { return 0.5f * (low + high); }
    float diagonal() const { return (high - low).norm(); }
};

/// What visit_bounds visits, in a box; the scene's own where nothing is there.
BoundingBox bounds_of(const DrawScene& scene, const DrawFrame& frame);

/// The part of a target of `whole`'s size that the frame's shapes may touch, `margin` pixels more on every
/// side. All of it where something reaches behind the camera.
PixelRect covered_rect(const DrawScene& scene, const DrawFrame& frame, const Eigen::Matrix4f& view_projection,
                       const PixelRect& whole, int margin);

}  // namespace unravel::render
