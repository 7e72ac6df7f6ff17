#include "sim/surface/crossings.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace unravel::sim {

namespace {

// Leaves searched by one task.
constexpr std::size_t leaves_of_task = 16;

// An edge that leaves a triangle's plane by less than this share of its length lies in it: of what is flat,
// all volumes are rounding.
constexpr long double in_plane = 1e-10L;

using Long = Eigen::Matrix<long double, 3, 1>;

// Six times the volume abcd. Sorting the corners first makes its sign the same for everyone but for the turn
// of an odd permutation.
long double volume(std::array<std::uint32_t, 4> particle, std::array<const Vec3*, 4> x) {
    bool turned = false;
    for (std::size_t pass = 0; pass < 3; ++pass) {
        for (std::size_t k = 0; k + 1 < 4 - pass; ++k) {
            if (particle[k] < particle[k + 1]) continue;
            std::swap(particle[k], particle[k + 1]);
            std::swap(x[k], x[k + 1]);
            turned = !turned;
        }
    }
    const Long origin = x[3]->cast<long double>();
    const Long a = x[0]->cast<long double>() - origin, b = x[1]->cast<long double>() - origin,
               c = x[2]->cast<long double>() - origin;
    const long double sorted = a.dot(b.cross(c));
    // Of a volume of zero, positive as sorted: the smallest number stands for it.
    const long double signed_ = sorted != 0 ? sorted : std::numeric_limits<long double>::min();
    return turned ? -signed_ : signed_;
}

}  // namespace

bool passes_through(const std::array<std::uint32_t, 5>& particles, const std::array<Vec3, 5>& x) {
    const auto of = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
        return volume({particles[i], particles[j], particles[k], particles[l]}, {&x[i], &x[j], &x[k], &x[l]});
    };
    const long double from = of(2, 3, 4, 0), to = of(2, 3, 4, 1);
    if ((from > 0) == (to > 0)) return false;
    const bool side = of(0, 1, 2, 3) > 0;
    if ((of(0, 1, 3, 4) > 0) != side || (of(0, 1, 4, 2) > 0) != side) return false;
    const double size = (x[3] - x[2]).norm() * (x[4] - x[2]).norm() * (x[1] - x[0]).norm();
    return std::abs(from - to) > in_plane * static_cast<long double>(size);
}

std::vector<Crossing> find_crossings(const Surface& surface, std::span<const Vec3> x, SurfaceTree& tree) {
    std::vector<Box> boxes(x.size());
    parallel_each(x.size(), [&](std::size_t p) { boxes[p] = {x[p], x[p]}; });
    tree.refit(surface, boxes);
    const std::size_t leaves = tree.leaves(), tasks = (leaves + leaves_of_task - 1) / leaves_of_task;
    std::vector<std::vector<Crossing>> found(tasks);
    const auto differ = [&](std::uint32_t p, std::uint32_t q) {
        return surface.joint[p] != surface.joint[q];
    };
    const auto try_leaves = [&](std::uint32_t edges_of, std::uint32_t triangles_of,
                                std::vector<Crossing>& out) {
        for (const std::uint32_t e : tree.edges.of(edges_of)) {
            const auto& [p, q] = surface.edges[e];
            for (const std::uint32_t t : tree.triangles.of(triangles_of)) {
                if (!tree.edge_box[e].overlaps(tree.triangle_box[t])) continue;
                const auto& [a, b, c] = surface.triangles[t];
                if (!differ(p, a) || !differ(p, b) || !differ(p, c) || !differ(q, a) || !differ(q, b) ||
                    !differ(q, c))
                    continue;
                if (passes_through({p, q, a, b, c}, {x[p], x[q], x[a], x[b], x[c]})) out.push_back({e, t});
            }
        }
    };
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
        for (std::size_t k = task * leaves_of_task; k < std::min(leaves, (task + 1) * leaves_of_task); ++k) {
            const auto leaf = static_cast<std::uint32_t>(k);
            tree.each_partner(leaf, [&](std::uint32_t other) {
                try_leaves(leaf, other, found[task]);
                if (other != leaf) try_leaves(other, leaf, found[task]);
            });
        }
    });
    std::vector<Crossing> all;
    for (const std::vector<Crossing>& part : found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    return all;
}

Vec3 place_of(const Surface& surface, std::span<const Vec3> x, const Crossing& crossing) {
    const auto& [p, q] = surface.edges[crossing.edge];
    const auto& [a, b, c] = surface.triangles[crossing.triangle];
    const Vec3 normal = (x[b] - x[a]).cross(x[c] - x[a]);
    const double from = normal.dot(x[p] - x[a]), to = normal.dot(x[q] - x[a]);
    return from == to ? Vec3(0.5 * (x[p] + x[q])) : Vec3(x[p] + from / (from - to) * (x[q] - x[p]));
}

}  // namespace unravel::sim
