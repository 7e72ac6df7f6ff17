#include "render/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unravel::render {

void visit_bounds(const DrawScene& scene, const DrawFrame& frame,
                  const std::function<void(const Vec3f&)>& visit) {
    for (const ClothMesh& mesh : scene.cloths)
        for (const std::uint32_t p : mesh.particle) visit(frame.positions[p]);
    for (std::size_t s = 0; s < scene.solids.size(); ++s) {
        if (scene.solids[s].plane) continue;
        if (scene.solids[s].deforms) {
            for (const Vec3f& x : frame.solid_positions[s]) visit(frame.solid_poses[s] * x);
            continue;
        }
        const Vec3f& half = scene.solids[s].half_extents;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3f sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            visit(frame.solid_poses[s] * Vec3f(half.cwiseProduct(sign)));
        }
    }
}

BoundingBox bounds_of(const DrawScene& scene, const DrawFrame& frame) {
    constexpr float far = std::numeric_limits<float>::max();
    BoundingBox box{Vec3f::Constant(far), Vec3f::Constant(-far)};
    const auto include = [&](const Vec3f& p) {
        box.low = box.low.cwiseMin(p);
        box.high = box.high.cwiseMax(p);
    };
    visit_bounds(scene, frame, std::ref(include));
    return box.low.x() <= box.high.x() ? box : BoundingBox{scene.bounds_low, scene.bounds_high};
}

PixelRect covered_rect(const DrawScene& scene, const DrawFrame& frame, const Eigen::Matrix4f& view_projection,
                       const PixelRect& whole, int margin) {
    constexpr float least_depth = 1e-3f;
    Vec2f low = Vec2f::Constant(2),
          high = Vec2f::Constant(-2);  // in clip space, where the picture is [−1, 1]²
    bool behind = false;
    const auto stretch = [&](const Vec3f& p) {
        const Eigen::Vector4f clip = view_projection * p.homogeneous();
        behind = behind || !(clip.w() > least_depth);
        const Vec2f at = clip.head<2>() / std::max(clip.w(), least_depth);
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    };
    visit_bounds(scene, frame, std::ref(stretch));
    if (behind) return whole;
    const auto pixel = [&](float at, int size) {
        return static_cast<int>(
            std::floor(0.5f * (std::clamp(at, -2.f, 2.f) + 1) * static_cast<float>(size)));
    };
    const int left = std::max(pixel(low.x(), whole.width) - margin, 0);
    const int bottom = std::max(pixel(low.y(), whole.height) - margin, 0);
    const int right = std::min(pixel(high.x(), whole.width) + 1 + margin, whole.width);
    const int top = std::min(pixel(high.y(), whole.height) + 1 + margin, whole.height);
    return {left, bottom, right - left, top - bottom};
}

}  // namespace unravel::render
