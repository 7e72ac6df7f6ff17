#include "render/normals.hpp"

namespace unravel::render {

void smooth_normals(const ClothMesh& mesh, std::span<const Vec3f> positions, std::span<Vec3f> normals) {
    for (const std::uint32_t p : mesh.particle) normals[p].setZero();
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t i = mesh.particle[a], j = mesh.particle[b], k = mesh.particle[c];
        // The cross product's length is twice the area: the weight comes with it.
        const Vec3f n = (positions[j] - positions[i]).cross(positions[k] - positions[i]);
        normals[i] += n;
        normals[j] += n;
        normals[k] += n;
    }
    for (const std::uint32_t p : mesh.particle) {
        const float length = normals[p].norm();
        normals[p] = length > 1e-20f ? Vec3f(normals[p] / length) : Vec3f(0, 1, 0);
    }
}

}  // namespace unravel::render
