#pragma once

#include <functional>
#include <span>
#include <vector>

#include "sim/surface/feature_pairs.hpp"

namespace unravel::sim {

/// Tells of pairs of features which of them may come near while particles move, at little more than nothing
/// for those that don't. Each pair has a slack: its distance when it was found, less what counts as near.
/// Convex features come no nearer to each other than their corners move relative to each other, so that a
/// pair sleeps for as long as that is less; and all pairs of two leaves of the tree sleep for as long as the
/// leaves as wholes have moved less than the least slack among them (after the bounds of Chen et al., "Offset
/// Geometric Contact", 2025, which are of each particle by itself).
class PairWatch {
public:
    /// Gap [m] at which a pair counts as near.
    using Gap = std::function<double(FeaturePair, const std::array<std::uint32_t, 2>&)>;

    /// Begins to watch pairs as found at x.
    void begin(const Surface& surface, const SurfaceTree& tree, const FeaturePairs& pairs,
               std::span<const Vec3> x, const Gap& gap);

    /// Those that may come near while particles go straight from x to `end`, in the order of the pairs.
    void wake(const Surface& surface, const SurfaceTree& tree, const FeaturePairs& pairs,
              std::span<const Vec3> x, std::span<const Vec3> end);

    PairList vertex_triangle, edge_edge;  ///< what the last wake() found

private:
    struct Motion {  // of a leaf's corners since begin(), at x and at the end: a ball around all of them [m]
        std::array<Vec3, 2> middle;
        std::array<double, 2> radius;
    };
    bool sleeps(const Motion& one, const Motion& other, double slack) const;
    bool sleeps(FeaturePair kind, const std::array<std::uint32_t, 4>& p, double slack) const;

    std::vector<Vec3> reference_;                // (particles) where pairs were found [m]
    std::array<std::vector<Vec3>, 2> moved_;     // (particles) from there, at x and at the end [m]
    std::vector<double> slack_vt_, slack_ee_;    // (pairs) m
    std::vector<double> slack_;                  // (blocks of pairs) m, the least in it
    std::vector<Motion> motion_;                 // (leaves)
    std::vector<PairList> found_vt_, found_ee_;  // (chunks of blocks)
};

}  // namespace unravel::sim
