#include "tool/picture/display_mesh.hpp"

#include <algorithm>
#include <map>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/model/surface.hpp"

namespace unravel::tool {

ClothMesh grid_mesh(const ClothPatch& patch, int level, std::size_t first) {
    ClothMesh mesh;
    const int factor = 1 << level, columns = factor * patch.cells_u() + 1,
              rows = factor * patch.cells_v() + 1;
    const int points = patch.tube ? columns - 1 : columns;
    mesh.picture_scale = Vec2(patch.size[0], patch.size[1]).cwiseInverse().cast<float>();
    const float du = static_cast<float>(patch.size[0] / std::max(columns - 1, 1));
    const float dv = static_cast<float>(patch.size[1] / std::max(rows - 1, 1));
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            mesh.particle.push_back(level == 0 ? patch.at(i, j)
                                               : static_cast<std::uint32_t>(first + j * points + i % points));
            mesh.uv.push_back({du * static_cast<float>(i), dv * static_cast<float>(j)});
        }
    }
    const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * columns + i); };
    for (int j = 0; j + 1 < rows; ++j) {
        for (int i = 0; i + 1 < columns; ++i) {
            const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                                d = vertex(i, j + 1);
            // u along +x, v along +z: counter-clockwise as seen from the front (+y). Diagonals alternate, so
            // that the shading has no grain.
            if ((i + j) % 2 == 0) {
                mesh.triangles.push_back({a, d, c});
                mesh.triangles.push_back({a, c, b});
            } else {
                mesh.triangles.push_back({a, d, b});
                mesh.triangles.push_back({b, d, c});
            }
        }
    }
    return mesh;
}

namespace {

// Texture coordinates for a mesh that has none: its rest shape seen along the axis that it is thinnest on.
// [m]
Vec2 seen_flat(const MeshCloth& mesh, const Vec3& x) {
    Eigen::Index thin = 0;
    mesh.extent().minCoeff(&thin);
    return thin == 0 ? Vec2(x.z(), x.y()) : thin == 1 ? Vec2(x.x(), x.z()) : Vec2(x.x(), x.y());
}

}  // namespace

ClothMesh face_mesh(const ClothPatch& patch) {
    ClothMesh mesh;
    const ClothSurface surface = surface_of(patch);
    bool placed = true;  // by texture coordinates of its own
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    const auto vertex = [&](const ClothSurface::Face& face, std::size_t k) {
        const auto [found, is_new] =
            known.try_emplace({face.vertex[k], face.uv[k]}, static_cast<std::uint32_t>(mesh.particle.size()));
        if (is_new) {
            const Vec2 uv = face.uv[k] == no_index
                                ? seen_flat(*patch.mesh, patch.mesh->rest[face.vertex[k]])
                                : Vec2(surface.uvs[face.uv[k]].cwiseProduct(surface.metres));
            placed = placed && face.uv[k] != no_index;
            mesh.particle.push_back(patch.first + face.vertex[k]);
            mesh.uv.push_back(uv.cast<float>());
        }
        return found->second;
    };
    for (const ClothSurface::Face& face : surface.faces) {
        const std::uint32_t a = vertex(face, 0), b = vertex(face, 1), c = vertex(face, 2);
        mesh.triangles.push_back({a, b, c});
        if (face.corners == 4) mesh.triangles.push_back({a, c, vertex(face, 3)});
    }
    if (placed) {
        mesh.picture_scale = surface.metres.cwiseInverse().cast<float>();
        return mesh;
    }
    // Seen flat, a picture spans the cloth once.
    Vec2f low = mesh.uv.front(), high = low;
    for (const Vec2f& uv : mesh.uv) {
        low = low.cwiseMin(uv);
        high = high.cwiseMax(uv);
    }
    for (Vec2f& uv : mesh.uv) uv -= low;
    mesh.picture_scale = (high - low).cwiseMax(1e-6f).cwiseInverse();
    return mesh;
}

}  // namespace unravel::tool
