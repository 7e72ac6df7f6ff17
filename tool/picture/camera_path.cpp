#include "tool/picture/camera_path.hpp"

#include <algorithm>
#include <numbers>

#include "render/camera.hpp"
#include "sim/mesh/placement.hpp"
#include "sim/solids/motion.hpp"

namespace unravel::tool {

namespace {

void shift_camera(CameraView& view, const Vec3f& by) {
    view.position += by;
    view.target += by;
}

// How far a cloth has gone from where it was placed [m].
Vec3f gone(const Cloth& cloth, const ClothPatch& patch, std::span<const Vec3f> positions) {
    Vec3 start = Vec3::Zero(), now = start;
    for (const Vec3& x : placed_particles(cloth)) start += x;
    for (const Vec3f& x : positions.subspan(patch.first, patch.count())) now += x.cast<double>();
    return ((now - start) / std::max(patch.count(), 1u)).cast<float>();
}

// Smooth: Catmull–Rom through unevenly spaced keys, at rest in the first and the last one.
template <class Value>
Vec3 through_keys(const std::vector<Camera::Key>& keys, Interpolation interpolation, double t,
                  Value&& value) {
    const std::size_t last = keys.size() - 1;
    const auto slope = [&](std::size_t k) -> Vec3 {
        if (k == 0 || k == last) return Vec3::Zero();
        return (value(keys[k + 1]) - value(keys[k - 1])) / (keys[k + 1].time - keys[k - 1].time);
    };
    if (t <= keys.front().time) return value(keys.front());
    if (t >= keys.back().time) return value(keys.back());
    std::size_t k = 0;
    while (keys[k + 1].time <= t) ++k;
    const double h = keys[k + 1].time - keys[k].time, s = (t - keys[k].time) / h, s2 = s * s, s3 = s2 * s;
    if (interpolation != Interpolation::smooth) {
        const double way = interpolation == Interpolation::hold     ? 0
                           : interpolation == Interpolation::linear ? s
                                                                    : 3 * s2 - 2 * s3;
        return value(keys[k]) + way * (value(keys[k + 1]) - value(keys[k]));
    }
    return (2 * s3 - 3 * s2 + 1) * value(keys[k]) + (s3 - 2 * s2 + s) * h * slope(k) +
           (3 * s2 - 2 * s3) * value(keys[k + 1]) + (s3 - s2) * h * slope(k + 1);
}

}  // namespace

CameraView camera_at(const Scene& scene, const Camera& camera, double t) {
    Vec3 position = camera.position, target = camera.target;
    if (!camera.keyframes.empty()) {
        const Interpolation by = camera.interpolation;
        position = through_keys(camera.keyframes, by, t, [](const Camera::Key& key) { return key.position; });
        target = through_keys(camera.keyframes, by, t, [](const Camera::Key& key) { return key.target; });
    }
    if (camera.orbit != 0) {
        const double angle = camera.orbit * std::numbers::pi / 180.0 * t / scene.clip.duration;
        position = target + Eigen::AngleAxisd(angle, Vec3::UnitY()) * (position - target);
    }
    CameraView view;
    view.position = position.cast<float>();
    view.target = target.cast<float>();
    view.fov = static_cast<float>(camera.fov);
    view.aperture = static_cast<float>(camera.aperture);
    view.focus = static_cast<float>(camera.focus.value_or(0));
    for (const Solid& solid : scene.solids)
        if (!camera.follow.empty() && solid.name == camera.follow)
            shift_camera(
                view,
                (solid_pose(solid, t).translation() - solid_pose(solid, 0).translation()).cast<float>());
    return view;
}

CameraView camera_of_frame(const Scene& scene, const Camera& camera, double t, const ClothModel& model,
                           std::span<const Vec3f> positions, const DrawScene& drawn) {
    CameraView view = camera_at(scene, camera, t);
    for (std::size_t c = 0; c < scene.cloths.size(); ++c)
        if (!camera.follow.empty() && scene.cloths[c].name == camera.follow)
            shift_camera(view, gone(scene.cloths[c], model.cloths[c], positions));
    if (!camera.fit) return view;
    return fitted(view, drawn,
                  static_cast<float>(scene.clip.size[0]) / static_cast<float>(scene.clip.size[1]));
}

}  // namespace unravel::tool
