#pragma once

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Matrices of a camera, column vectors, GL clip conventions (x right, y up, depth −1 … 1).
struct Projection {
    Eigen::Matrix4f view, projection;
    Vec3f position;           ///< m
    float pixels_per_radian;  ///< per unit of frame height: multiply by the height in pixels, divide by depth
                              ///< [m]
};

/// Camera with its depth range fitted to the scene. `low`, `high`: bounds [m]; `reach`: how far the ground
/// goes from their centre [m]. An up vector along the line of sight is replaced by another one.
Projection make_camera(const CameraView& view, float aspect, const Vec3f& low, const Vec3f& high,
                       float reach);

/// The camera moved, without being turned, to where the scene's bounds and their shadow on the ground fill a
/// picture of this aspect but for a rim, its target as far away as their middle.
CameraView fitted(const CameraView& view, const DrawScene& scene, float aspect);

/// The camera moved sideways by `lens` in the plane of its lens [m], its frustum sheared so that what lies
/// `focus` away [m] stays where it is in the picture, which then moves by `shift`, in units of its half
/// sizes.
Projection shifted(const Projection& camera, const Vec2f& lens, float focus, const Vec2f& shift);

/// World to the camera's frame, which looks along −z.
Eigen::Matrix4f look_at(const Vec3f& eye, const Vec3f& target, const Vec3f& up);

}  // namespace unravel::render
