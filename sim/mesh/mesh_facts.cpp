#include "sim/mesh/mesh_facts.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "sim/mesh/half_edges.hpp"

namespace unravel::sim {

namespace {

MeshFacts facts_of_faces(const std::vector<Vec3>& x, std::span<const PolygonMesh::Face> faces) {
    MeshFacts facts;
    facts.vertices = x.size();
    Vec3 low = x.front(), high = low;
    for (const Vec3& at : x) {
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    }
    facts.extent = high - low;
    const std::vector<HalfEdge> sides = half_edges(faces);
    std::vector<double> lengths;
    for_each_edge(sides, [&](std::size_t first, std::size_t) {
        lengths.push_back((x[sides[first].low] - x[sides[first].high]).norm());
    });
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    facts.spacing = *middle;
    facts.borders = border_loops(faces);
    return facts;
}

}  // namespace

MeshFacts facts_of(const MeshCloth& mesh) {
    return facts_of_faces(mesh.rest, mesh.faces);
}

MeshFacts facts_of(const MeshSolid& body) {
    std::vector<PolygonMesh::Face> faces;
    for (const auto& [a, b, c] : body.triangles)
        faces.push_back({3, {a, b, c, no_index}, {no_index, no_index, no_index, no_index}});
    return facts_of_faces(body.rest, faces);
}

std::string facts_text(const MeshFacts& facts) {
    const Vec3& e = facts.extent;
    return fmt::format("{:.3g} x {:.3g} x {:.3g} m, {} vertices {:.3g} mm apart, {}", e.x(), e.y(), e.z(),
                       facts.vertices, 1e3 * facts.spacing, holes_text(facts.borders));
}

}  // namespace unravel::sim
