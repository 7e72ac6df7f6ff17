#include <limits>

#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

double mesh_distance(const Solid& solid, const Vec3& local, Vec3& normal) {
    const MeshTree::Nearest nearest =
        solid.geometry->tree.nearest(local, std::numeric_limits<double>::infinity());
    normal = nearest.normal;
    return nearest.distance;
}

Vec3 mesh_half_extents(const Solid& solid) {
    Vec3 half = Vec3::Zero();
    for (const Vec3& x : solid.geometry->rest) half = half.cwiseMax(x.cwiseAbs());
    return half;
}

}  // namespace

const ShapeLaw mesh_shape{
    .sizes = {},
    .distance = mesh_distance,
    .half_extents = mesh_half_extents,
    .reach = [](const Solid& solid) { return solid.geometry->reach; },
    .rounding = nullptr,
    .surface = nullptr,
};

}  // namespace unravel::sim
