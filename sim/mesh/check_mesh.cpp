#include "sim/mesh/check_mesh.hpp"

#include <fmt/core.h>

#include "sim/mesh/half_edges.hpp"
#include "sim/mesh/repair.hpp"

namespace unravel::sim {

namespace {

class MeshCheck {
public:
    MeshCheck(const PolygonMesh& mesh, MeshMessages& said) : mesh_(mesh), said_(said) {}

    bool has_faces() {
        if (mesh_.faces.empty())
            said_.fault(0, "the mesh has no faces", "write triangles or quads (f lines)");
        return !mesh_.faces.empty();
    }

    void coincident() {
        const auto pairs = coincident_vertices(mesh_);
        if (pairs.empty()) return;
        const auto& [later, first] = pairs.front();
        const int line = mesh_.line_of_vertex(first);
        std::string what = fmt::format("vertex {} lies on vertex {}{}", vertex(later), vertex(first),
                                       line > 0 ? fmt::format(" (line {})", line) : "");
        if (pairs.size() > 1) what += fmt::format(", and {} more on others", pairs.size() - 1);
        said_.fault(mesh_.line_of_vertex(later), std::move(what),
                    "mesh_merge = true makes them one, mesh_merge = false keeps them apart; a seam (l line) "
                    "sews them");
    }

    void edges() {
        const std::vector<HalfEdge> sides = half_edges(mesh_.faces);
        for_each_edge(sides, [&](std::size_t first, std::size_t last) { judge_edge(sides, first, last); });
    }

    void closed() {
        const auto loops = border_loops(mesh_.faces);
        if (loops.empty()) return;
        said_.fault(
            0, fmt::format("the body is open: {}", holes_text(loops)),
            "mesh_holes = \"cap\" closes them, mesh_shell = 0.01 takes the surface as a shell 1 cm thick");
    }

private:
    std::uint32_t vertex(std::uint32_t v) const { return mesh_.file_vertex[v] + 1; }
    std::uint32_t face(std::uint32_t f) const { return mesh_.file_face[f] + 1; }

    void judge_edge(const std::vector<HalfEdge>& all, std::size_t first, std::size_t last) {
        if (said_.full()) return;
        const HalfEdge& a = all[first];
        const std::string edge = fmt::format("the edge from vertex {} to {}", vertex(a.low), vertex(a.high));
        if (last - first > 2) {
            std::string faces;
            for (std::size_t k = first; k < last; ++k)
                faces += fmt::format("{}{}", k > first ? ", " : "", face(all[k].face));
            said_.fault(mesh_.line_of_face(all[last - 1].face),
                        fmt::format("{} belongs to {} faces ({})", edge, last - first, faces),
                        "a sheet has at most two at an edge: remove or separate the others");
        } else if (last - first == 2 && a.forward == all[first + 1].forward) {
            const std::uint32_t f = a.face, g = all[first + 1].face;
            const int line = mesh_.line_of_face(f);
            said_.fault(mesh_.line_of_face(g),
                        fmt::format("faces {}{} and {} face opposite ways across {}", face(f),
                                    line > 0 ? fmt::format(" (line {})", line) : "", face(g), edge),
                        "a sheet has two sides, and this one (a Möbius strip) has one: cut it");
        }
    }

    const PolygonMesh& mesh_;
    MeshMessages& said_;
};

}  // namespace

void check_cloth_mesh(const PolygonMesh& mesh, bool apart, MeshMessages& said) {
    MeshCheck check(mesh, said);
    if (!check.has_faces()) return;
    if (!apart) check.coincident();
    check.edges();
}

void check_solid_mesh(const PolygonMesh& mesh, bool closed, MeshMessages& said) {
    MeshCheck check(mesh, said);
    if (!check.has_faces()) return;
    check.edges();
    if (closed && said.faults.empty()) check.closed();
}

}  // namespace unravel::sim
