#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/solids/distance.hpp"
#include "sim/solids/profile.hpp"

namespace unravel::sim {

namespace {

ShapeSurface box_surface(const Solid& solid, float detail) {
    constexpr float eighth_turn = std::numbers::pi_v<float> / 4;
    const int straight = static_cast<int>(12 * detail);
    const Eigen::Vector3f half = 0.5f * solid.size.cast<float>();
    const float round = std::clamp(static_cast<float>(solid.round), 0.f, half.minCoeff());
    // Along each axis of a face: an arc at either end and straight steps between, as signed offsets.
    constexpr int arc = 4;
    const int steps = 2 * arc + straight;
    // Inner point and tangent of the tilt.
    const auto along = [&](int i, float half_length) -> std::pair<float, float> {
        const float inner = half_length - round;
        if (i < arc) return {-inner, -std::tan(eighth_turn * static_cast<float>(arc - i) / arc)};
        if (i > arc + straight)
            return {inner, std::tan(eighth_turn * static_cast<float>(i - arc - straight) / arc)};
        return {inner * (2.f * static_cast<float>(i - arc) / static_cast<float>(straight) - 1), 0.f};
    };
    ShapeSurface surface;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.f, 1.f}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            add_grid(surface, steps, steps, [&](int r, int c, Eigen::Vector3f& p, Eigen::Vector3f& n) {
                // Swapping rows and columns on one side keeps triangles counter-clockwise from outside.
                const auto [pu, nu] = along(side > 0 ? r : c, half[u]);
                const auto [pv, nv] = along(side > 0 ? c : r, half[v]);
                n[axis] = side;
                n[u] = round > 0 ? nu : 0;
                n[v] = round > 0 ? nv : 0;
                n.normalize();
                p[axis] = side * (half[axis] - round);
                p[u] = pu;
                p[v] = pv;
                p += round * n;
            });
        }
    return surface;
}

}  // namespace

const ShapeLaw box_shape{
    .sizes = {.size = true, .round = true},
    .distance =
        [](const Solid& solid, const Vec3& local, Vec3& normal) {
            // A rounded box is a smaller sharp box with a skin.
            const Vec3 half = (0.5 * solid.size - Vec3::Constant(solid.round)).cwiseMax(0.0);
            return box_distance<Vec3>(half, local, normal) - solid.round;
        },
    .half_extents = [](const Solid& solid) -> Vec3 { return 0.5 * solid.size; },
    .reach = [](const Solid& solid) { return 0.5 * solid.size.norm(); },
    .rounding = [](const Solid& solid) { return std::min(solid.round, 0.5 * solid.size.minCoeff()); },
    .surface = box_surface,
};

}  // namespace unravel::sim
