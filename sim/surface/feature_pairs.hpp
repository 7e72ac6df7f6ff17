#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/surface/impact.hpp"
#include "sim/surface/surface_tree.hpp"

namespace unravel::sim {

/// Two features of a surface: a vertex (particle) and a triangle, or two edges, the smaller number first.
using PairList = std::vector<std::array<std::uint32_t, 2>>;

/// Pairs of features that are near each other and have no corner in common, and the memory of their search.
struct FeaturePairs {
    PairList vertex_triangle, edge_edge;
    /// Pairs of two leaves of the tree, or within one: [begin, end) of either list, one block after the
    /// other.
    struct Block {
        std::uint32_t one = 0, other = 0;  ///< leaves
        std::uint32_t vt_begin = 0, vt_end = 0, ee_begin = 0, ee_end = 0;
    };
    std::vector<Block> blocks;  ///< those that have pairs
    struct Found {
        PairList vertex_triangle, edge_edge;
        std::vector<Block> blocks;
    };
    std::vector<Found> found;  ///< (groups of leaves)
};

/// Finds all pairs whose boxes (SurfaceTree::refit) overlap. Their order follows from the tree's shape alone.
void find_pairs(const Surface& surface, const SurfaceTree& tree, FeaturePairs& out);

/// The particles of a pair, in the order of impact.hpp.
inline std::array<std::uint32_t, 4> corners_of(const Surface& surface, FeaturePair kind,
                                               const std::array<std::uint32_t, 2>& pair) {
    if (kind == FeaturePair::vertex_triangle) {
        const auto& [a, b, c] = surface.triangles[pair[1]];
        return {pair[0], a, b, c};
    }
    const auto& [a, b] = surface.edges[pair[0]];
    const auto& [c, d] = surface.edges[pair[1]];
    return {a, b, c, d};
}

}  // namespace unravel::sim
