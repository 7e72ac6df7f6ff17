#include "sim/model/surface.hpp"

#include <cmath>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/repair.hpp"

namespace unravel::sim {

namespace {

ClothSurface surface_of_mesh(const MeshCloth& mesh) {
    ClothSurface out;
    out.uvs = mesh.uvs;
    double area = 0, flat = 0;
    for (const PolygonMesh::Face& face : mesh.faces) {
        out.faces.push_back({face.corners, face.vertex, face.uv});
        bool has_uv = true;
        for (std::size_t k = 0; k < face.corners; ++k) has_uv = has_uv && face.uv[k] != no_index;
        if (!has_uv) continue;
        area += face_area(mesh.rest, face);
        for (std::size_t k = 2; k < face.corners; ++k) {
            const Vec2 a = mesh.uvs[face.uv[k - 1]] - mesh.uvs[face.uv[0]],
                       b = mesh.uvs[face.uv[k]] - mesh.uvs[face.uv[0]];
            flat += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
        }
    }
    if (flat > 0) out.metres.setConstant(std::sqrt(area / flat));
    return out;
}

}  // namespace

ClothSurface surface_of(const ClothPatch& patch) {
    if (!patch.grid()) return surface_of_mesh(*patch.mesh);
    ClothSurface out;
    out.metres = {patch.size[0], patch.size[1]};
    const int columns = patch.cells_u() + 1, rows = patch.particles[1];
    const auto along = [](int index, int cells) { return cells > 0 ? double(index) / cells : 0.0; };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i)
            out.uvs.push_back({along(i, patch.cells_u()), along(j, patch.cells_v())});
    }
    const auto uv = [&](int i, int j) { return static_cast<std::uint32_t>(j * columns + i); };
    for (int j = 0; j < patch.cells_v(); ++j) {
        for (int i = 0; i < patch.cells_u(); ++i) {
            const auto at = [&](int k, int l) { return patch.at(k, l) - patch.first; };
            // u along +x, v along +z: counter-clockwise as seen from the front (+y).
            out.faces.push_back({4,
                                 {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)},
                                 {uv(i, j), uv(i, j + 1), uv(i + 1, j + 1), uv(i + 1, j)}});
        }
    }
    return out;
}

}  // namespace unravel::sim
