#include <limits>

#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace

const ShapeLaw plane_shape{
    .sizes = {},
    .distance =
        [](const Solid&, const Vec3& local, Vec3& normal) {
            normal = Vec3::UnitY();
            return local.y();
        },
    .half_extents = [](const Solid&) -> Vec3 { return Vec3::Constant(endless); },
    .reach = [](const Solid&) { return endless; },
    .rounding = nullptr,
    .surface = nullptr,
};

}  // namespace unravel::sim
