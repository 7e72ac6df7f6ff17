#include "render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace unravel::render {

Eigen::Matrix4f look_at(const Vec3f& eye, const Vec3f& target, const Vec3f& up) {
    Vec3f forward = target - eye;
    if (forward.norm() < 1e-9f) forward = Vec3f(0, 0, -1);
    forward.normalize();
    Vec3f right = forward.cross(up);
    if (right.norm() < 1e-6f)
        right = forward.cross(std::abs(forward.y()) < 0.9f ? Vec3f(0, 1, 0) : Vec3f(0, 0, -1));
    right.normalize();
    Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
    view.block<1, 3>(0, 0) = right.transpose();
    view.block<1, 3>(1, 0) = right.cross(forward).transpose();
    view.block<1, 3>(2, 0) = -forward.transpose();
    view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * eye;
    return view;
}

Projection make_camera(const CameraView& view, float aspect, const Vec3f& low, const Vec3f& high,
                       float reach) {
    const Vec3f centre = 0.5f * (low + high);
    const float radius = 0.5f * (high - low).norm(), distance = (view.position - centre).norm();
    // Nearer than the scene's sphere where the camera stands outside it, and than the ground before a scene
    // that is small; depth precision is ample for the rest.
    const float near =
        std::max(std::min(distance - 1.5f * radius, 0.2f * distance), 0.02f * std::max(distance, radius));
    const float far = distance + std::max(2 * radius, reach);
    const float focal = 1 / std::tan(0.5f * view.fov * std::numbers::pi_v<float> / 180);

    Projection camera;
    camera.view = look_at(view.position, view.target, view.up);
    camera.projection = Eigen::Matrix4f::Zero();
    camera.projection(0, 0) = focal / aspect;
    camera.projection(1, 1) = focal;
    camera.projection(2, 2) = -(far + near) / (far - near);
    camera.projection(2, 3) = -2 * far * near / (far - near);
    camera.projection(3, 2) = -1;
    camera.position = view.position;
    camera.pixels_per_radian = 0.5f * focal;
    return camera;
}

}  // namespace unravel::render
