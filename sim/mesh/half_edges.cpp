#include "sim/mesh/half_edges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace unravel::sim {

std::vector<HalfEdge> half_edges(std::span<const PolygonMesh::Face> faces) {
    std::vector<HalfEdge> out;
    std::size_t sides = 0;
    for (const PolygonMesh::Face& face : faces) sides += face.corners;
    out.reserve(sides);
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const PolygonMesh::Face& face = faces[f];
        for (std::size_t k = 0; k < face.corners; ++k) {
            const std::uint32_t a = face.vertex[k], b = face.vertex[(k + 1) % face.corners];
            out.push_back({std::min(a, b), std::max(a, b), f, a < b});
        }
    }
    std::sort(out.begin(), out.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return out;
}

std::vector<std::vector<std::uint32_t>> border_loops(std::span<const PolygonMesh::Face> faces) {
    const std::vector<HalfEdge> sides = half_edges(faces);
    std::vector<std::array<std::uint32_t, 2>> open;  // from, to
    for_each_edge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first == 1) open.push_back({sides[first].from(), sides[first].to()});
    });
    std::sort(open.begin(), open.end());
    std::vector<char> used(open.size(), 0);
    std::vector<std::vector<std::uint32_t>> loops;
    for (std::size_t start = 0; start < open.size(); ++start) {
        std::vector<std::uint32_t> loop;
        for (std::size_t at = start; at < open.size() && !used[at];) {
            used[at] = 1;
            loop.push_back(open[at][0]);
            const std::array<std::uint32_t, 2> next{open[at][1], 0};
            at = static_cast<std::size_t>(std::lower_bound(open.begin(), open.end(), next) - open.begin());
            while (at < open.size() && used[at] && open[at][0] == next[0]) ++at;
            if (at < open.size() && open[at][0] != next[0]) break;
        }
        if (!loop.empty()) loops.push_back(std::move(loop));
    }
    std::stable_sort(loops.begin(), loops.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return loops;
}

std::string holes_text(const std::vector<std::vector<std::uint32_t>>& loops) {
    constexpr std::size_t most = 8;
    if (loops.empty()) return "no hole";
    std::vector<std::size_t> lengths;
    for (std::size_t k = 0; k < std::min(loops.size(), most); ++k) lengths.push_back(loops[k].size());
    return fmt::format("{} of {}{} edges", counted(loops.size(), "hole", "holes"), fmt::join(lengths, ", "),
                       loops.size() > most ? ", … " : "");
}

std::vector<std::uint32_t> connected_pieces(std::size_t faces, const std::vector<HalfEdge>& sides) {
    std::vector<std::uint32_t> root(faces);
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t f) {
        while (root[f] != f) f = root[f] = root[root[f]];
        return f;
    };
    for (std::size_t k = 1; k < sides.size(); ++k) {
        if (!sides[k].same_edge(sides[k - 1])) continue;
        const std::uint32_t a = find(sides[k].face), b = find(sides[k - 1].face);
        root[std::max(a, b)] = std::min(a, b);
    }
    std::vector<std::uint32_t> piece(faces);
    std::uint32_t pieces = 0;
    for (std::uint32_t f = 0; f < faces; ++f) piece[f] = find(f) == f ? pieces++ : piece[find(f)];
    return piece;
}

}  // namespace unravel::sim
