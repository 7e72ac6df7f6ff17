#include "sim/mesh/polygon_mesh.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "sim/mesh/cut_polygon.hpp"

namespace unravel::sim {

std::string counted(std::size_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

bool add_polygon(PolygonMesh& mesh, std::vector<std::uint32_t> vertex, std::vector<std::uint32_t> uv,
                 std::uint32_t part, std::uint32_t number, int line) {
    // A corner that is said twice in a row is one corner.
    std::size_t kept = 0;
    for (std::size_t k = 0; k < vertex.size(); ++k) {
        if (vertex[k] == vertex[(k + 1) % vertex.size()]) continue;
        vertex[kept] = vertex[k];
        uv[kept++] = uv[k];
    }
    vertex.resize(kept);
    if (kept < 3) {
        ++mesh.flat_faces;
        return false;
    }
    std::vector<Vec3> corners;
    for (const std::uint32_t v : vertex) corners.push_back(mesh.positions[v]);
    std::vector<Piece> pieces{{0, 1, 2, kept == 4 ? 3 : no_index}};
    const bool cut = kept > 4 || (kept == 4 && !is_convex(corners));
    if (cut) pieces = cut_polygon(corners);
    for (const Piece& piece : pieces) {
        PolygonMesh::Face face;
        face.corners = piece[3] == no_index ? 3 : 4;
        face.vertex.fill(no_index);
        face.uv.fill(no_index);
        for (std::size_t k = 0; k < face.corners; ++k) {
            face.vertex[k] = vertex[piece[k]];
            face.uv[k] = uv[piece[k]];
        }
        mesh.add_face(face, part, number, line);
    }
    return cut;
}

void note_cut_faces(std::size_t cut, MeshMessages& said) {
    if (cut == 0) return;
    said.notes.push_back(
        fmt::format("{} of more than four corners or not convex: cut into triangles and quads",
                    counted(cut, "face", "faces")));
}

void finish_numbering(PolygonMesh& mesh) {
    for (auto& [name, vertices] : mesh.groups) {
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    }
    mesh.file_vertices = mesh.positions.size();
    mesh.file_vertex.resize(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.file_vertices; ++v) mesh.file_vertex[v] = v;
}

}  // namespace unravel::sim
