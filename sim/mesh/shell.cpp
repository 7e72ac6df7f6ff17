#include "sim/mesh/shell.hpp"

#include <Eigen/Geometry>

#include "sim/mesh/half_edges.hpp"

namespace unravel::sim {

std::vector<Triangle> shell_triangles(std::span<const Triangle> surface, std::size_t vertices) {
    const auto n = static_cast<std::uint32_t>(vertices);
    std::vector<Triangle> out(surface.begin(), surface.end());
    std::vector<PolygonMesh::Face> faces;
    for (const auto& [a, b, c] : surface) {
        out.push_back({n + a, n + c, n + b});
        faces.push_back({3, {a, b, c, no_index}, {no_index, no_index, no_index, no_index}});
    }
    const std::vector<HalfEdge> sides = half_edges(faces);
    for_each_edge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first != 1) return;
        const std::uint32_t a = sides[first].from(), b = sides[first].to();
        out.push_back({b, a, n + a});
        out.push_back({b, n + a, n + b});
    });
    return out;
}

void thicken(std::span<const Triangle> surface, double thickness, std::vector<Vec3>& x) {
    std::vector<Vec3> normal(x.size(), Vec3::Zero());
    for (const auto& [a, b, c] : surface) {
        const Vec3 area = (x[b] - x[a]).cross(x[c] - x[a]);
        for (const std::uint32_t v : {a, b, c}) normal[v] += area;
    }
    const std::size_t n = x.size();
    x.resize(2 * n);
    for (std::size_t v = 0; v < n; ++v) {
        const double length = normal[v].norm();
        const Vec3 out =
            length > 0 ? Vec3(0.5 * thickness / length * normal[v]) : Vec3(0, 0.5 * thickness, 0);
        x[n + v] = x[v] - out;
        x[v] += out;
    }
}

}  // namespace unravel::sim
