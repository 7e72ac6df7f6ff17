#include <numbers>

#include "sim/solids/distance.hpp"
#include "sim/solids/profile.hpp"

namespace unravel::sim {

namespace {

ShapeSurface sphere_surface(const Solid& solid, float detail) {
    const int sectors = sectors_of(detail);
    std::vector<ProfilePoint> profile;
    add_arc(profile, 0, 0, static_cast<float>(solid.radius), 0, std::numbers::pi_v<float>, sectors / 2);
    return turn(profile, sectors);
}

}  // namespace

const ShapeLaw sphere_shape{
    .sizes = {.radius = true},
    .distance =
        [](const Solid& solid, const Vec3& local, Vec3& normal) {
            normal = direction<Vec3>(local, Vec3::UnitY());
            return local.stableNorm() - solid.radius;
        },
    .half_extents = [](const Solid& solid) -> Vec3 { return Vec3::Constant(solid.radius); },
    .reach = [](const Solid& solid) { return solid.radius; },
    .rounding = [](const Solid& solid) { return solid.radius; },
    .surface = sphere_surface,
};

}  // namespace unravel::sim
