#include "render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

Projection shifted(const Projection& camera, const Vec2f& lens, float focus, const Vec2f& shift) {
    Projection moved = camera;
    moved.view.block<2, 1>(0, 3) -= lens;
    moved.position += camera.view.block<2, 3>(0, 0).transpose() * lens;
    // Divided by the depth, −z, a factor on z moves all of the picture by the same.
    for (int axis = 0; axis < 2; ++axis)
        moved.projection(axis, 2) -= camera.projection(axis, axis) * lens[axis] / focus + shift[axis];
    return moved;
}

CameraView fitted(const CameraView& view, const DrawScene& scene, float aspect) {
    constexpr float rim = 0.06f, lowest_light = 0.3f;
    const Eigen::Matrix3f turn = look_at(view.position, view.target, view.up).topLeftCorner<3, 3>();
    const float up = (1 - rim) * std::tan(0.5f * view.fov * std::numbers::pi_v<float> / 180),
                side = up * aspect;
    // Of each point at (x, y) and depth z from a camera in the origin: on either side, how far beyond the
    // edge of its picture it lies.
    float right = -std::numeric_limits<float>::max(), left = right, top = right, bottom = right;
    const auto hold = [&](const Vec3f& p) {
        const Vec3f at = turn * p;
        right = std::max(right, at.x() + side * at.z());
        left = std::max(left, -at.x() + side * at.z());
        top = std::max(top, at.y() + up * at.z());
        bottom = std::max(bottom, -at.y() + up * at.z());
    };
    const Vec3f key = scene.key_direction.normalized();
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p(corner & 1 ? scene.bounds_high.x() : scene.bounds_low.x(),
                      corner & 2 ? scene.bounds_high.y() : scene.bounds_low.y(),
                      corner & 4 ? scene.bounds_high.z() : scene.bounds_low.z());
        hold(p);
        if (scene.show_ground && !scene.transparent)
            hold(p - key * (std::max(p.y() - scene.ground_height, 0.f) / std::max(key.y(), lowest_light)));
    }
    // As near as both sides allow, in the middle between them.
    const float back = std::max((right + left) / (2 * side), (top + bottom) / (2 * up));
    CameraView moved = view;
    moved.position = turn.transpose() * Vec3f(0.5f * (right - left), 0.5f * (top - bottom), back);
    const Vec3f ahead = (view.target - view.position).normalized();
    moved.target =
        moved.position + ahead * (0.5f * (scene.bounds_low + scene.bounds_high) - moved.position).dot(ahead);
    return moved;
}

}  // namespace unravel::render
