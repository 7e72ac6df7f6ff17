#include "sim/self_collision/solid_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/solids/depth.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

// To which depths in solids are known [m].
constexpr double depth_precision = 5e-4;
// Cosine below which two places of a solid look different ways.
constexpr double other_way = 0.5;
// Cosine of the angle by which a surface may turn under a particle in a step, and at how many offsets from it
// the particle is still on it.
constexpr double round_edge = 0.95, touching_skins = 2;

}  // namespace

CutView::CutView(const Solid& solid, const Pose& to_local, std::span<const Vec3> x, double longest)
    : solid_(solid), local_(x.size()), slope_(x.size()), distance_(x.size()), known_(x.size()) {
    const double radius = law_of(solid.shape).reach(solid);
    parallel_each(x.size(), [&](std::size_t p) {
        local_[p] = to_local * x[p];
        distance_[p] = local_[p].norm() - radius;
        known_[p] = distance_[p] <= longest;
        if (known_[p]) distance_[p] = signed_distance(solid, local_[p], &slope_[p]);
    });
}

// A lower bound of the distance on an edge or a triangle.
template <std::size_t N>
double CutView::bound(const std::array<std::uint32_t, N>& corners) const {
    double bound = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t p : corners) {
        if (!known_[p]) continue;
        double here = distance_[p];
        for (const std::uint32_t q : corners)
            here = std::min(here, distance_[p] + slope_[p].dot(local_[q] - local_[p]));
        bound = std::max(bound, here);
    }
    // Farther than the longest edge from all corners, none of them known.
    return std::isinf(bound) ? 1.0 : bound;
}

bool CutView::cuts(const std::array<std::uint32_t, 2>& edge) const {
    const auto& [a, b] = edge;
    const bool in_a = distance_[a] < -touching_depth, in_b = distance_[b] < -touching_depth;
    if (in_a || in_b) return in_a != in_b;
    if (bound(edge) >= -touching_depth) return false;
    const double depth = -least_on_edge(solid_, nullptr, {local_[a], local_[b]}, depth_precision);
    return depth > solid_.offset || (depth > touching_depth && slope_[a].dot(slope_[b]) < other_way);
}

double CutView::depth(const std::array<std::uint32_t, 3>& face) const {
    if (bound(face) >= -touching_depth) return 0;
    const auto& [a, b, c] = face;
    return -least_on_triangle(solid_, nullptr, {local_[a], local_[b], local_[c]}, depth_precision);
}

double longest_edge(const Surface& surface, std::span<const Vec3> x) {
    double longest = 0;
    for (const auto& [a, b] : surface.edges) longest = std::max(longest, (x[a] - x[b]).squaredNorm());
    return std::sqrt(longest);
}

std::uint64_t count_cuts(const ClothModel& model, double t, std::span<const Vec3> x) {
    const Surface& surface = model.contact->surface;
    const double longest = longest_edge(surface, x);
    std::uint64_t count = 0;
    std::vector<std::uint8_t> cut(surface.edges.size());
    for (const Solid& solid : model.solids) {
        if (!solid.by_surfaces()) continue;
        const CutView view(solid, solid_pose(solid, t).inverse(Eigen::Isometry), x, longest);
        parallel_each(cut.size(), [&](std::size_t e) { cut[e] = view.cuts(surface.edges[e]); });
        count += static_cast<std::uint64_t>(std::ranges::count(cut, std::uint8_t{1}));
    }
    return count;
}

namespace {

// What has happened to one particle that went straight from a to b, both in the solid's frame.
enum class Way { clear, turned, through };
Way judge_way(const Solid& solid, const Vec3& a, const Vec3& b) {
    const Vec3 way = b - a;
    const double length = way.squaredNorm(),
                 reach = law_of(solid.shape).reach(solid) + touching_skins * solid.offset;
    const double share = length > 0 ? std::clamp(-a.dot(way) / length, 0.0, 1.0) : 0.0;
    if ((a + share * way).squaredNorm() > reach * reach) return Way::clear;
    Vec3 from, to;
    const double before = signed_distance(solid, a, &from), after = signed_distance(solid, b, &to);
    const double turn = from.dot(to);
    if (turn > round_edge || before < 0 || after < 0) return Way::clear;
    if (turn < -other_way && least_on_edge(solid, nullptr, {a, b}, depth_precision) < -touching_depth)
        return Way::through;
    return std::max(before, after) < touching_skins * solid.offset ? Way::turned : Way::clear;
}

}  // namespace

Ways judge_ways(const ClothModel& model, double t, std::span<const Vec3> x, double t_next,
                std::span<const Vec3> next) {
    Ways out;
    std::vector<Way> ways(x.size());
    for (const Solid& solid : model.solids) {
        if (!solid.by_surfaces()) continue;
        const Pose before = solid_pose(solid, t).inverse(Eigen::Isometry),
                   after = solid_pose(solid, t_next).inverse(Eigen::Isometry);
        parallel_each(x.size(),
                      [&](std::size_t p) { ways[p] = judge_way(solid, before * x[p], after * next[p]); });
        out.through += static_cast<std::uint64_t>(std::ranges::count(ways, Way::through));
        out.turned += static_cast<std::uint64_t>(std::ranges::count(ways, Way::turned));
    }
    return out;
}

}  // namespace unravel::sim
