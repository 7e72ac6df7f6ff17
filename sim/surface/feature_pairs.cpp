#include "sim/surface/feature_pairs.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace unravel::sim {

namespace {

// Leaves searched by one task.
constexpr std::size_t group_size = 16;

// Pairs within one leaf, or between two. Of leaves that lie side by side, most of what is in one does not
// reach the other's box at all, and is passed over before all is tried against all.
struct LeafPairs {
    const Surface& surface;
    const SurfaceTree& tree;
    PairList& vertex_triangle;
    PairList& edge_edge;
    std::vector<std::uint32_t> first, second;  // scratch: features of two leaves that reach the other's box

    static void reaching(std::span<const std::uint32_t> features, std::span<const Box> boxes,
                         const Box& other, std::vector<std::uint32_t>& out) {
        out.clear();
        for (const std::uint32_t k : features) {
            if (boxes[k].overlaps(other)) out.push_back(k);
        }
    }

    bool differ(std::uint32_t p, std::uint32_t q) const { return surface.joint[p] != surface.joint[q]; }
    void try_vertices(std::uint32_t vertices_of, std::uint32_t triangles_of) {
        reaching(tree.vertices.of(vertices_of), tree.vertex_box, tree.box_of(triangles_of), first);
        if (first.empty()) return;
        reaching(tree.triangles.of(triangles_of), tree.triangle_box, tree.box_of(vertices_of), second);
        for (const std::uint32_t p : first) {
            const Box& box = tree.vertex_box[p];
            for (const std::uint32_t t : second) {
                if (!box.overlaps(tree.triangle_box[t])) continue;
                const auto& [a, b, c] = surface.triangles[t];
                if (differ(p, a) && differ(p, b) && differ(p, c)) vertex_triangle.push_back({p, t});
            }
        }
    }
    void try_edges(std::uint32_t one, std::uint32_t other) {
        reaching(tree.edges.of(one), tree.edge_box, tree.box_of(other), first);
        if (first.empty()) return;
        reaching(tree.edges.of(other), tree.edge_box, tree.box_of(one), second);
        for (const std::uint32_t e : first) {
            const Box& box = tree.edge_box[e];
            const auto& [a, b] = surface.edges[e];
            for (const std::uint32_t g : second) {
                if ((one == other && g <= e) || !box.overlaps(tree.edge_box[g])) continue;
                const auto& [c, d] = surface.edges[g];
                if (differ(a, c) && differ(a, d) && differ(b, c) && differ(b, d))
                    edge_edge.push_back({std::min(e, g), std::max(e, g)});
            }
        }
    }
    void operator()(std::uint32_t one, std::uint32_t other) {
        try_vertices(one, other);
        if (one != other) try_vertices(other, one);
        try_edges(one, other);
    }
};

void join(const std::vector<FeaturePairs::Found>& parts, FeaturePairs& out) {
    out.vertex_triangle.clear();
    out.edge_edge.clear();
    out.blocks.clear();
    for (const FeaturePairs::Found& part : parts) {
        const auto vt = static_cast<std::uint32_t>(out.vertex_triangle.size());
        const auto ee = static_cast<std::uint32_t>(out.edge_edge.size());
        for (FeaturePairs::Block block : part.blocks) {
            block.vt_begin += vt;
            block.vt_end += vt;
            block.ee_begin += ee;
            block.ee_end += ee;
            out.blocks.push_back(block);
        }
        out.vertex_triangle.insert(out.vertex_triangle.end(), part.vertex_triangle.begin(),
                                   part.vertex_triangle.end());
        out.edge_edge.insert(out.edge_edge.end(), part.edge_edge.begin(), part.edge_edge.end());
    }
}

}  // namespace

void find_pairs(const Surface& surface, const SurfaceTree& tree, FeaturePairs& out) {
    const std::size_t leaves = tree.leaves(), groups = (leaves + group_size - 1) / group_size;
    out.found.resize(groups);
    tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t group) {
        FeaturePairs::Found& found = out.found[group];
        found.vertex_triangle.clear();
        found.edge_edge.clear();
        found.blocks.clear();
        LeafPairs pairs{surface, tree, found.vertex_triangle, found.edge_edge, {}, {}};
        const auto counts = [&] {
            return std::array{static_cast<std::uint32_t>(found.vertex_triangle.size()),
                              static_cast<std::uint32_t>(found.edge_edge.size())};
        };
        for (std::size_t k = group * group_size; k < std::min(leaves, (group + 1) * group_size); ++k) {
            const auto leaf = static_cast<std::uint32_t>(k);
            tree.each_partner(leaf, [&](std::uint32_t other) {
                const auto [vt, ee] = counts();
                pairs(leaf, other);
                const auto [vt_end, ee_end] = counts();
                if (vt_end > vt || ee_end > ee) found.blocks.push_back({leaf, other, vt, vt_end, ee, ee_end});
            });
        }
    });
    join(out.found, out);
}

}  // namespace unravel::sim
