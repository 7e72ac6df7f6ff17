#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/solids/distance.hpp"
#include "sim/solids/profile.hpp"

namespace unravel::sim {

namespace {

double cylinder_distance(const Solid& solid, const Vec3& local, Vec3& normal) {
    // A rectangle in the half plane of distance from the axis and height.
    const Vec2 radial(local.x(), local.z());
    const Vec2 away = direction<Vec2>(radial, Vec2::UnitX());
    const Vec2 half(std::max(solid.radius - solid.round, 0.0),
                    std::max(0.5 * solid.height - solid.round, 0.0));
    Vec2 in_plane;
    const double distance =
        box_distance<Vec2>(half, Vec2(radial.stableNorm(), local.y()), in_plane) - solid.round;
    normal = Vec3(in_plane.x() * away.x(), in_plane.y(), in_plane.x() * away.y());
    return distance;
}

ShapeSurface cylinder_surface(const Solid& solid, float detail) {
    constexpr float pi = std::numbers::pi_v<float>;
    const auto radius = static_cast<float>(solid.radius);
    const float half = 0.5f * static_cast<float>(solid.height),
                round = std::min({static_cast<float>(solid.round), radius, half});
    std::vector<ProfilePoint> profile;
    const float flat = radius - round;
    for (const float t : {0.f, 0.3f, 0.6f, 0.85f, 1.f}) profile.push_back({flat * t, half, 0, 1});
    add_arc(profile, flat, half - round, round, 0, pi / 2, 6);
    for (int i = 1; i < 16; ++i)
        profile.push_back({radius, (half - round) * (1 - static_cast<float>(i) / 8.f), 1, 0});
    add_arc(profile, flat, round - half, round, pi / 2, pi, 6);
    for (const float t : {1.f, 0.85f, 0.6f, 0.3f, 0.f}) profile.push_back({flat * t, -half, 0, -1});
    return turn(profile, sectors_of(detail));
}

}  // namespace

const ShapeLaw cylinder_shape{
    .sizes = {.radius = true, .height = true, .round = true},
    .distance = cylinder_distance,
    .half_extents = [](const Solid& solid) -> Vec3 {
        return {solid.radius, 0.5 * solid.height, solid.radius};
    },
    .reach = [](const Solid& solid) { return std::hypot(solid.radius, 0.5 * solid.height); },
    .rounding =
        [](const Solid& solid) {
            return std::min({solid.round, solid.radius, 0.5 * solid.height});
        },
    .surface = cylinder_surface,
};

}  // namespace unravel::sim
