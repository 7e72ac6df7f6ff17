#include "sim/constraints/contact.hpp"
#include "sim/solids/sdf.hpp"

namespace unravel::sim {

void keep_outside(std::span<const Solid> solids, const SolidPoses& poses, const Constraints& constraints,
                  double h, std::span<Vec3> x, std::span<Vec3> v) {
    parallel_each(x.size(), [&](std::size_t p) {
        if (constraints.fully(static_cast<std::uint32_t>(p))) return;
        for (std::size_t s = 0; s < solids.size(); ++s) {
            if (poses.reach[s].is_outside(x[p])) continue;
            const Vec3 local = poses.next[s].inverse(Eigen::Isometry) * x[p];
            const SurfacePoint surface = nearest_surface(solids[s], poses.of(solids[s], s), true, local, 0.0);
            if (surface.distance >= 0) continue;
            const Vec3 normal = poses.next[s].linear() * surface.normal;
            const Vec3 velocity = (x[p] - poses.now[s] * surface.carried) / h;
            x[p] -= surface.distance * normal;
            const double closing = normal.dot(v[p] - velocity);
            if (closing < 0) v[p] -= closing * normal;
        }
    });
}

}  // namespace unravel::sim
