#include "sim/constraints/near_solids.hpp"
#include "sim/solids/sdf.hpp"

namespace unravel::sim {

namespace {

// A corner between solids is found within so many rounds over them; what is pinched has none.
constexpr int most_rounds = 8;
// Where two normals have less than this of their directions to themselves, what one pushes out the other
// pushes in: there is no way out along the first.
constexpr double least_own_share = 0.05;

// Where to go from a surface with this normal without coming nearer to the one that was left before: the way
// that takes a metre of depth away. `before` is zero where there was none.
Vec3 way_out(const Vec3& normal, const Vec3& before) {
    const Vec3 along = normal - normal.dot(before) * before;
    const double own = along.squaredNorm();
    return own > least_own_share ? Vec3(along / own) : normal;
}

}  // namespace

void keep_outside(std::span<const Solid> solids, const SolidPoses& poses, const Constraints& constraints,
                  double h, std::span<Vec3> x, std::span<Vec3> v) {
    const auto keep = [&](std::size_t p, const NearSolids& near) {
        if (constraints.fully(static_cast<std::uint32_t>(p))) return;
        Vec3 before = Vec3::Zero();
        std::size_t last = solids.size();
        for (int round = 0; round < most_rounds; ++round) {
            bool moved = false;
            for (std::size_t s = 0; s < solids.size(); ++s) {
                // What it has just left holds it no more. What it is pushed into may be any of them.
                if (s == last || (round == 0 && last == solids.size() && !near.has(s)) ||
                    poses.reach[s].is_outside(x[p]))
                    continue;
                const Vec3 local = poses.next[s].inverse(Eigen::Isometry) * x[p];
                const SurfacePoint surface =
                    nearest_surface(solids[s], poses.of(solids[s], s), true, local, 0.0);
                if (surface.distance >= 0) continue;
                const Vec3 normal = poses.next[s].linear() * surface.normal, out = way_out(normal, before);
                const Vec3 velocity = (x[p] - poses.now[s] * surface.carried) / h;
                x[p] -= surface.distance * out;
                const double closing = normal.dot(v[p] - velocity);
                if (closing < 0) v[p] -= closing * out;
                before = normal;
                last = s;
                moved = true;
            }
            if (!moved || solids.size() == 1) break;
        }
    };
    parallel_chunks(x.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        const auto near = NearSolids::to_be_in(poses.reach, x.subspan(begin, end - begin));
        if (near.none()) return;
        for (std::size_t p = begin; p < end; ++p) keep(p, near);
    });
}

}  // namespace unravel::sim
