#include "sim/run/passages.hpp"

#include <algorithm>
#include <limits>

#include "sim/constraints/contact.hpp"
#include "sim/solids/depth.hpp"
#include "sim/solids/motion.hpp"

namespace unravel::sim {

namespace {

// To which depths in solids are known [m]; what is less deep touches.
constexpr double precision = 5e-4, touching_depth = 1e-6;

// One solid: which edges pass through its surface, and the deepest face.
void judge_solid(const ClothModel& model, std::uint32_t number, const DeformedSolid* deformed, double t,
                 std::span<const Vec3> x, Passages& out) {
    const Solid& solid = model.solids[number];
    const Surface& surface = model.contact->surface;
    const Pose to_local = solid_pose(solid, t).inverse(Eigen::Isometry);
    std::vector<Vec3> local(x.size());
    std::vector<double> distance(x.size());
    parallel_each(x.size(), [&](std::size_t p) {
        local[p] = to_local * x[p];
        distance[p] =
            nearest_surface(solid, deformed, true, local[p], std::numeric_limits<double>::infinity())
                .distance;
    });
    std::vector<std::uint8_t> passes(surface.edges.size());
    parallel_each(surface.edges.size(), [&](std::size_t e) {
        const auto& [a, b] = surface.edges[e];
        const bool in_a = distance[a] < -touching_depth, in_b = distance[b] < -touching_depth;
        const bool far = distance[a] + distance[b] > (local[b] - local[a]).norm();
        passes[e] = in_a != in_b ||
                    (!in_a && !far &&
                     least_on_edge(solid, deformed, {local[a], local[b]}, precision) < -touching_depth);
    });
    out.solids += static_cast<std::uint64_t>(std::count(passes.begin(), passes.end(), std::uint8_t{1}));
    const auto deeper = [&](double least, std::uint32_t p) {
        if (-least <= std::max(out.deepest, touching_depth)) return;
        out.deepest = -least;
        out.deepest_particle = p;
        out.deepest_solid = number;
    };
    for (std::uint32_t p = 0; p < x.size(); ++p) deeper(distance[p], p);
    std::vector<double> least(surface.triangles.size());
    parallel_each(surface.triangles.size(), [&](std::size_t k) {
        const auto& [a, b, c] = surface.triangles[k];
        const double longest = std::max(
            {(local[a] - local[b]).norm(), (local[b] - local[c]).norm(), (local[c] - local[a]).norm()});
        least[k] = distance[a];
        if (std::min({distance[a], distance[b], distance[c]}) < longest)
            least[k] = least_on_triangle(solid, deformed, {local[a], local[b], local[c]}, precision);
    });
    for (std::uint32_t k = 0; k < least.size(); ++k) deeper(least[k], surface.triangles[k][0]);
}

}  // namespace

Passages find_passages(const ClothModel& model, double t, std::span<const Vec3> x) {
    Passages out;
    if (!model.contact) return out;
    if (model.self_collision) {
        SurfaceTree tree = model.contact->tree;
        out.cloth = find_crossings(model.contact->surface, x, tree);
    }
    if (model.solids.empty()) return out;
    SolidPoses poses;
    pose_solids(model.solids, t, 0, poses);
    for (std::uint32_t s = 0; s < model.solids.size(); ++s)
        judge_solid(model, s, poses.of(model.solids[s], s), t, x, out);
    return out;
}

}  // namespace unravel::sim
