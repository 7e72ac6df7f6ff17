#include <algorithm>
#include <numbers>

#include "sim/solids/distance.hpp"
#include "sim/solids/profile.hpp"

namespace unravel::sim {

namespace {

double capsule_distance(const Solid& solid, const Vec3& local, Vec3& normal) {
    const double on_axis = std::clamp(local.y(), -0.5 * solid.height, 0.5 * solid.height);
    const Vec3 off = local - Vec3(0, on_axis, 0);
    normal = direction<Vec3>(off, Vec3::UnitX());
    return off.stableNorm() - solid.radius;
}

ShapeSurface capsule_surface(const Solid& solid, float detail) {
    constexpr float pi = std::numbers::pi_v<float>;
    const int sectors = sectors_of(detail);
    const auto radius = static_cast<float>(solid.radius);
    const float half = 0.5f * static_cast<float>(solid.height);
    std::vector<ProfilePoint> profile;
    add_arc(profile, 0, half, radius, 0, pi / 2, sectors / 4);
    for (int i = 1; i < 16; ++i) profile.push_back({radius, half * (1 - static_cast<float>(i) / 8.f), 1, 0});
    add_arc(profile, 0, -half, radius, pi / 2, pi, sectors / 4);
    return turn(profile, sectors);
}

}  // namespace

const ShapeLaw capsule_shape{
    .sizes = {.radius = true, .height = true},
    .distance = capsule_distance,
    .half_extents = [](const Solid& solid) -> Vec3 {
        return {solid.radius, 0.5 * solid.height + solid.radius, solid.radius};
    },
    .reach = [](const Solid& solid) { return solid.radius + 0.5 * solid.height; },
    .rounding = [](const Solid& solid) { return solid.radius; },
    .surface = capsule_surface,
};

}  // namespace unravel::sim
