#include "sim/solids/sdf.hpp"

#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

double signed_distance(const Solid& solid, const Vec3& local, Vec3* gradient) {
    Vec3 normal;
    const double distance = law_of(solid.shape).distance(solid, local, normal);
    if (gradient) *gradient = normal;
    return distance;
}

SurfacePoint nearest_surface(const Solid& solid, const DeformedSolid* deformed, bool at_end,
                             const Vec3& local, double cutoff) {
    SurfacePoint out;
    out.carried = local;
    if (solid.shape != Shape::mesh) {
        out.distance = signed_distance(solid, local, &out.normal);
        return out;
    }
    const MeshTree& tree = !deformed ? solid.geometry->tree : at_end ? deformed->next : deformed->now;
    const MeshTree::Nearest nearest = tree.nearest(local, cutoff);
    out.distance = nearest.distance;
    out.normal = nearest.normal;
    if (deformed && nearest.distance <= cutoff) {
        const std::array<std::uint32_t, 3>& corners = tree.triangle(nearest.triangle);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = corners[static_cast<std::size_t>(k)];
            const Vec3 moved = deformed->positions_next[v] - deformed->positions_now[v];
            out.carried += (at_end ? -1.0 : 1.0) * nearest.weights[k] * moved;
        }
    }
    return out;
}

}  // namespace unravel::sim
