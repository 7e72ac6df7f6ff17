#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// A side of a face, named by its smaller and larger vertex, so that sorting brings neighbours together.
struct HalfEdge {
    std::uint32_t low, high, face;
    bool forward;  ///< runs from low to high
    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
    std::uint32_t from() const { return forward ? low : high; }
    std::uint32_t to() const { return forward ? high : low; }
};

/// All sides of all faces, sorted by edge, then by face.
std::vector<HalfEdge> half_edges(std::span<const PolygonMesh::Face> faces);

/// Calls visit(first, last) with the bounds in `sides`, as half_edges() gives them, of each edge's own.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& sides, Visit&& visit) {
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t last = first + 1;
        while (last < sides.size() && sides[last].same_edge(sides[first])) ++last;
        visit(first, last);
        first = last;
    }
}

/// The closed loops of edges that only one face has: of a sheet its border and its holes. Vertices of each in
/// the order in which its faces have them; the longest first (by edges), then by the smallest vertex.
std::vector<std::vector<std::uint32_t>> border_loops(std::span<const PolygonMesh::Face> faces);

/// "no hole", "1 hole of 68 edges", "3 holes of 68, 28, 28 edges"; of many only the first.
std::string holes_text(const std::vector<std::vector<std::uint32_t>>& loops);

/// Pieces that hang together by edges: a number from 0 for each face, in the order of their first faces.
std::vector<std::uint32_t> connected_pieces(std::size_t faces, const std::vector<HalfEdge>& sides);

}  // namespace unravel::sim
