#include "render/coarse_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace unravel::render {

namespace {

/// Who is joined to whom by an edge of a triangle: neighbours of i are at[first[i]] … at[first[i + 1]], twice
/// where two triangles share the edge.
struct EdgeLists {
    std::vector<std::uint32_t> first, at;
    std::vector<char> border;  ///< whether an edge with but one triangle ends here
};

EdgeLists edge_lists(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices) {
    EdgeLists lists{.first = std::vector<std::uint32_t>(vertices + 1, 0),
                    .at = std::vector<std::uint32_t>(6 * triangles.size()),
                    .border = std::vector<char>(vertices, 0)};
    for (const auto& triangle : triangles)
        for (const std::uint32_t v : triangle) lists.first[v + 1] += 2;
    std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
    std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
    for (const auto& triangle : triangles)
        for (const std::size_t k : {0, 1, 2})
            for (const std::size_t other : {1, 2}) lists.at[next[triangle[k]]++] = triangle[(k + other) % 3];
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto begin = lists.at.begin() + lists.first[v], end = lists.at.begin() + lists.first[v + 1];
        std::sort(begin, end);
        for (auto it = begin; it != end;) {
            const auto after = std::upper_bound(it, end, *it);
            if (after - it == 1) lists.border[v] = 1;
            it = after;
        }
    }
    return lists;
}

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// Seeds so that no two are nearer than `apart` edges and every vertex is within that of one; `near` is the
/// one that each vertex is nearest to.
std::vector<std::uint32_t> nearest_seeds(const EdgeLists& lists, int apart) {
    const std::size_t vertices = lists.border.size();
    std::vector<std::uint32_t> near(vertices, nobody), front, next;
    std::vector<int> away(vertices, std::numeric_limits<int>::max());
    // Each seed takes over what is nearer to it than to those before.
    const auto spread = [&](std::uint32_t seed) {
        near[seed] = seed;
        away[seed] = 0;
        front.assign(1, seed);
        for (int hops = 1; hops < apart && !front.empty(); ++hops, front.swap(next)) {
            next.clear();
            for (const std::uint32_t v : front)
                for (std::uint32_t k = lists.first[v]; k < lists.first[v + 1]; ++k) {
                    const std::uint32_t w = lists.at[k];
                    if (away[w] <= hops) continue;
                    away[w] = hops;
                    near[w] = seed;
                    next.push_back(w);
                }
        }
    };
    for (const bool border : {true, false})
        for (std::uint32_t v = 0; v < vertices; ++v)
            if (near[v] == nobody && (lists.border[v] != 0) == border) spread(v);
    return near;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> coarse_triangles(const ClothMesh& mesh, std::size_t count) {
    // Particles numbered from 0, each with one of the vertices that show it.
    std::vector<std::uint32_t> number, shown_by;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t v = 0; v < mesh.particle.size(); ++v) {
        const std::uint32_t p = mesh.particle[v];
        if (p >= number.size()) number.resize(p + 1, nobody);
        if (number[p] != nobody) continue;
        number[p] = static_cast<std::uint32_t>(shown_by.size());
        shown_by.push_back(v);
    }
    if (shown_by.size() <= count) return mesh.triangles;
    for (const auto& [a, b, c] : mesh.triangles)
        triangles.push_back({number[mesh.particle[a]], number[mesh.particle[b]], number[mesh.particle[c]]});

    // Within a number of edges r of a vertex of a triangle grid lie about 2 r² others; of two seeds' discs
    // half.
    const int apart = static_cast<int>(
        std::lround(std::sqrt(static_cast<double>(shown_by.size()) / static_cast<double>(count))));
    if (apart < 2) return mesh.triangles;
    const std::vector<std::uint32_t> near = nearest_seeds(edge_lists(triangles, shown_by.size()), apart);
    std::vector<std::array<std::uint32_t, 3>> coarse;
    for (const auto& [a, b, c] : triangles) {
        const std::uint32_t i = near[a], j = near[b], k = near[c];
        if (i != j && j != k && k != i) coarse.push_back({shown_by[i], shown_by[j], shown_by[k]});
    }
    return coarse;
}

}  // namespace unravel::render
