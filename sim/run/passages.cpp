#include "sim/run/passages.hpp"

#include <algorithm>

#include "sim/self_collision/solid_cuts.hpp"
#include "sim/solids/motion.hpp"

namespace unravel::sim {

namespace {

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
