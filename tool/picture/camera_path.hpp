#pragma once

#include <span>

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Camera of the scene at time t: smoothly through its keyframes, then the orbit about its target, then along
/// with the solid that it follows.
CameraView camera_at(const Scene& scene, const Camera& camera, double t);

/// The same of a frame, along with a cloth, too, by the mean of where its particles are now [m] and were at
/// the start; and fitted to the clip (render/camera.hpp) where the camera asks for that.
CameraView camera_of_frame(const Scene& scene, const Camera& camera, double t, const ClothModel& model,
                           std::span<const Vec3f> positions, const DrawScene& drawn);

}  // namespace unravel::tool
