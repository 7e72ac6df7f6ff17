#include "sim/run/passages.hpp"

#include <algorithm>
#include <limits>

#include "sim/solids/depth.hpp"
#include "sim/solids/motion.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

// To which depths in solids are known [m]; what is less deep touches.
constexpr double precision = 5e-4, touching_depth = 1e-6;
// Cosine below which two places of a solid look different ways.
constexpr double other_way = 0.5;

// The cloth in the frame of one solid of a closed form. All of those are convex: a distance to one is nowhere
// less than the tangent planes at particles say.
struct CutView {
    const Solid& solid;
    std::vector<Vec3> local, slope;  // (particles) where it is; the distance's gradient there, where known
    std::vector<double> distance;    // (particles) m; unless known, a lower bound
    std::vector<std::uint8_t> known;

    CutView(const Solid& of, const Pose& to_local, std::span<const Vec3> x, double longest)
        : solid(of), local(x.size()), slope(x.size()), distance(x.size()), known(x.size()) {
        const double radius = law_of(solid.shape).reach(solid);
        parallel_each(x.size(), [&](std::size_t p) {
            local[p] = to_local * x[p];
            distance[p] = local[p].norm() - radius;
            known[p] = distance[p] <= longest;
            if (known[p]) distance[p] = signed_distance(solid, local[p], &slope[p]);
        });
    }

    // A lower bound of the distance on an edge or a triangle.
    template <std::size_t N>
    double bound(const std::array<std::uint32_t, N>& corners) const {
        double bound = -std::numeric_limits<double>::infinity();
        for (const std::uint32_t p : corners) {
            if (!known[p]) continue;
            double here = distance[p];
            for (const std::uint32_t q : corners)
                here = std::min(here, distance[p] + slope[p].dot(local[q] - local[p]));
            bound = std::max(bound, here);
        }
        // Farther than the longest edge from all corners, none of them known.
        return std::isinf(bound) ? 1.0 : bound;
    }

    bool cuts(const std::array<std::uint32_t, 2>& edge) const {
        const auto& [a, b] = edge;
        const bool in_a = distance[a] < -touching_depth, in_b = distance[b] < -touching_depth;
        if (in_a || in_b) return in_a != in_b;
        if (bound(edge) >= -touching_depth) return false;
        const double depth = -least_on_edge(solid, nullptr, {local[a], local[b]}, precision);
        return depth > solid.offset || (depth > touching_depth && slope[a].dot(slope[b]) < other_way);
    }
    double depth(const std::array<std::uint32_t, 3>& face) const {
        if (bound(face) >= -touching_depth) return 0;
        const auto& [a, b, c] = face;
        return -least_on_triangle(solid, nullptr, {local[a], local[b], local[c]}, precision);
    }
};

double longest_edge(const Surface& surface, std::span<const Vec3> x) {
    double longest = 0;
    for (const auto& [a, b] : surface.edges) longest = std::max(longest, (x[a] - x[b]).squaredNorm());
    return std::sqrt(longest);
}

void judge_solid(const ClothModel& model, std::uint32_t number, const CutView& view, Passages& out) {
    const Surface& surface = model.contact->surface;
    std::vector<std::uint8_t> cut(surface.edges.size());
    parallel_each(cut.size(), [&](std::size_t e) { cut[e] = view.cuts(surface.edges[e]); });
    *out.solids += static_cast<std::uint64_t>(std::ranges::count(cut, std::uint8_t{1}));
    std::vector<double> depth(surface.triangles.size());
    parallel_each(depth.size(), [&](std::size_t k) { depth[k] = view.depth(surface.triangles[k]); });
    const auto deepest = std::ranges::max_element(depth);
    if (deepest == depth.end() || *deepest <= std::max(out.deepest, touching_depth)) return;
    out.deepest = *deepest;
    out.deepest_particle = surface.triangles[static_cast<std::size_t>(deepest - depth.begin())][0];
    out.deepest_solid = number;
}

}  // namespace

Passages find_passages(const ClothModel& model, double t, std::span<const Vec3> x) {
    Passages out;
    if (!model.contact) return out;
    const Surface& surface = model.contact->surface;
    out.may_cross = model.self_collision.has_value() || model.cloths.size() > 1;
    if (out.may_cross) {
        SurfaceTree tree = model.contact->tree;
        out.cloth = find_crossings(surface, x, tree);
    }
    const double longest = model.solids.empty() ? 0 : longest_edge(surface, x);
    for (std::uint32_t s = 0; s < model.solids.size(); ++s) {
        const Solid& solid = model.solids[s];
        if (solid.shape == Shape::plane || solid.shape == Shape::mesh) continue;
        if (!out.solids) out.solids = 0;
        judge_solid(model, s, CutView(solid, solid_pose(solid, t).inverse(Eigen::Isometry), x, longest), out);
    }
    return out;
}

}  // namespace unravel::sim
