#include "sim/surface/pair_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unravel::sim {

namespace {

// Slack is taken for this much less than it is, more than rounding can make of it.
constexpr double surely = 1 - 1e-9;

// A lower bound of two features' distance: that of the balls around them where it tells them well apart, the
// distance itself where it does not.
double distance_bound(FeaturePair kind, const std::array<Vec3, 4>& x) {
    const bool vertex = kind == FeaturePair::vertex_triangle;
    const Vec3 one = vertex ? x[0] : Vec3(0.5 * (x[0] + x[1]));
    const Vec3 other = vertex ? Vec3((x[1] + x[2] + x[3]) / 3) : Vec3(0.5 * (x[2] + x[3]));
    double radius = vertex ? 0.0 : (x[0] - one).norm(), farthest = 0;
    for (std::size_t k = vertex ? 1 : 2; k < 4; ++k)
        farthest = std::max(farthest, (x[k] - other).squaredNorm());
    radius += std::sqrt(farthest);
    const double apart = (one - other).norm() - radius;
    return apart > radius ? apart : combined(weights_of(kind, x), x).norm();
}

}  // namespace

void PairWatch::begin(const Surface& surface, const SurfaceTree& tree, const FeaturePairs& pairs,
                      std::span<const Vec3> x, const Gap& gap) {
    reference_.assign(x.begin(), x.end());
    const auto measure = [&](FeaturePair kind, const PairList& list, std::vector<double>& slack) {
        slack.resize(list.size());
        parallel_each(list.size(), [&](std::size_t k) {
            const std::array<std::uint32_t, 4> p = corners_of(surface, kind, list[k]);
            slack[k] =
                surely * distance_bound(kind, {x[p[0]], x[p[1]], x[p[2]], x[p[3]]}) - gap(kind, list[k]);
        });
    };
    measure(FeaturePair::vertex_triangle, pairs.vertex_triangle, slack_vt_);
    measure(FeaturePair::edge_edge, pairs.edge_edge, slack_ee_);
    slack_.resize(pairs.blocks.size());
    parallel_each(slack_.size(), [&](std::size_t k) {
        const FeaturePairs::Block& block = pairs.blocks[k];
        double least = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = block.vt_begin; i < block.vt_end; ++i) least = std::min(least, slack_vt_[i]);
        for (std::uint32_t i = block.ee_begin; i < block.ee_end; ++i) least = std::min(least, slack_ee_[i]);
        slack_[k] = least;
    });
    motion_.resize(tree.leaves());
}

bool PairWatch::sleeps(const Motion& one, const Motion& other, double slack) const {
    for (std::size_t k = 0; k < 2; ++k) {
        if ((one.middle[k] - other.middle[k]).norm() + one.radius[k] + other.radius[k] >= slack) return false;
    }
    return true;
}

bool PairWatch::sleeps(FeaturePair kind, const std::array<std::uint32_t, 4>& p, double slack) const {
    if (slack <= 0) return false;
    const std::size_t cut = kind == FeaturePair::vertex_triangle ? 1 : 2;
    for (const std::vector<Vec3>& moved : moved_) {
        for (std::size_t i = 0; i < cut; ++i) {
            for (std::size_t j = cut; j < 4; ++j) {
                if ((moved[p[i]] - moved[p[j]]).squaredNorm() >= slack * slack) return false;
            }
        }
    }
    return true;
}

void PairWatch::wake(const Surface& surface, const SurfaceTree& tree, const FeaturePairs& pairs,
                     std::span<const Vec3> x, std::span<const Vec3> end) {
    for (std::vector<Vec3>& moved : moved_) moved.resize(x.size());
    parallel_each(x.size(), [&](std::size_t p) {
        moved_[0][p] = x[p] - reference_[p];
        moved_[1][p] = end[p] - reference_[p];
    });
    parallel_each(tree.leaves(), [&](std::size_t leaf) {
        const std::span<const std::uint32_t> corners = tree.corners.of(static_cast<std::uint32_t>(leaf));
        for (std::size_t k = 0; k < 2; ++k) {
            Vec3 middle = Vec3::Zero();
            for (const std::uint32_t p : corners) middle += moved_[k][p];
            middle /= static_cast<double>(corners.size());
            double farthest = 0;
            for (const std::uint32_t p : corners)
                farthest = std::max(farthest, (moved_[k][p] - middle).squaredNorm());
            motion_[leaf].middle[k] = middle;
            motion_[leaf].radius[k] = std::sqrt(farthest);
        }
    });
    found_vt_.resize(chunk_count(pairs.blocks.size()));
    found_ee_.resize(chunk_count(pairs.blocks.size()));
    parallel_chunks(pairs.blocks.size(), [&](std::size_t chunk, std::size_t begin, std::size_t last) {
        found_vt_[chunk].clear();
        found_ee_[chunk].clear();
        for (std::size_t k = begin; k < last; ++k) {
            const FeaturePairs::Block& block = pairs.blocks[k];
            if (sleeps(motion_[block.one], motion_[block.other], slack_[k])) continue;
            const auto look = [&](FeaturePair kind, const PairList& list, const std::vector<double>& slack,
                                  std::uint32_t from, std::uint32_t to, PairList& out) {
                for (std::uint32_t i = from; i < to; ++i) {
                    if (!sleeps(kind, corners_of(surface, kind, list[i]), slack[i])) out.push_back(list[i]);
                }
            };
            look(FeaturePair::vertex_triangle, pairs.vertex_triangle, slack_vt_, block.vt_begin, block.vt_end,
                 found_vt_[chunk]);
            look(FeaturePair::edge_edge, pairs.edge_edge, slack_ee_, block.ee_begin, block.ee_end,
                 found_ee_[chunk]);
        }
    });
    const auto join = [](const std::vector<PairList>& parts, PairList& out) {
        out.clear();
        for (const PairList& part : parts) out.insert(out.end(), part.begin(), part.end());
    };
    join(found_vt_, vertex_triangle);
    join(found_ee_, edge_edge);
}

}  // namespace unravel::sim
