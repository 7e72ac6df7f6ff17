#include "render/solid_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace unravel::render {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Adds a (rows + 1) × (columns + 1) grid of vertices; `point(row, column)` sets position and normal.
void add_grid(Tessellation& mesh, int rows, int columns,
              const std::function<void(int, int, Vec3f&, Vec3f&)>& point) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c) {
            Vec3f position, normal;
            point(r, c, position, normal);
            mesh.positions.push_back(position);
            mesh.normals.push_back(normal);
        }
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const std::uint32_t a = first + r * (columns + 1) + c, b = a + 1, d = a + columns + 1, e = d + 1;
            mesh.indices.insert(mesh.indices.end(), {a, d, b, b, d, e});
        }
}

}  // namespace

CreasedMesh crease(std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::span<const Vec3f> positions) {
    const float least_cosine = std::cos(40 * pi / 180);
    std::vector<Vec3f> normals;
    for (const auto& [a, b, c] : triangles)
        normals.push_back((positions[b] - positions[a]).cross(positions[c] - positions[a]).normalized());

    // Corners of triangles, three each, are joined where a smooth edge runs from their vertex.
    std::vector<std::uint32_t> joined(3 * triangles.size());
    std::iota(joined.begin(), joined.end(), 0u);
    const auto root = [&](std::uint32_t corner) {
        while (joined[corner] != corner) corner = joined[corner] = joined[joined[corner]];
        return corner;
    };
    struct Side {
        std::uint32_t low, high;        // vertices
        std::uint32_t at_low, at_high;  // corners
    };
    std::vector<Side> sides;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t i = 3 * t + k, j = 3 * t + (k + 1) % 3;
            const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            sides.push_back(a < b ? Side{a, b, i, j} : Side{b, a, j, i});
        }
    std::ranges::stable_sort(sides, {}, [](const Side& side) { return std::pair(side.low, side.high); });
    for (std::size_t s = 0; s + 1 < sides.size(); ++s) {
        const Side &one = sides[s], &other = sides[s + 1];
        if (one.low != other.low || one.high != other.high) continue;
        if (normals[one.at_low / 3].dot(normals[other.at_low / 3]) < least_cosine) continue;
        joined[root(other.at_low)] = root(one.at_low);
        joined[root(other.at_high)] = root(one.at_high);
    }

    CreasedMesh mesh;
    constexpr std::uint32_t unset = 0xffffffffu;
    std::vector<std::uint32_t> vertex_of(joined.size(), unset);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::array<std::uint32_t, 3>& out = mesh.triangles.emplace_back();
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t& vertex = vertex_of[root(3 * t + k)];
            if (vertex == unset) {
                vertex = static_cast<std::uint32_t>(mesh.source.size());
                mesh.source.push_back(triangles[t][k]);
            }
            out[k] = vertex;
        }
    }
    return mesh;
}

Tessellation tessellate_mesh(const CreasedMesh& mesh, std::span<const Vec3f> positions) {
    Tessellation out;
    for (const std::uint32_t v : mesh.source) out.positions.push_back(positions[v]);
    out.normals.assign(mesh.source.size(), Vec3f::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
        // The cross product's length is twice the area: the weight comes with it.
        const Vec3f n = (out.positions[b] - out.positions[a]).cross(out.positions[c] - out.positions[a]);
        for (const std::uint32_t v : {a, b, c}) out.normals[v] += n;
        out.indices.insert(out.indices.end(), {a, b, c});
    }
    for (Vec3f& n : out.normals) n = n.norm() > 0 ? Vec3f(n.normalized()) : Vec3f(0, 1, 0);
    return out;
}

Tessellation tessellate_ground(float reach) {
    constexpr int steps = 32;
    // Cubic spacing: three times finer in the middle, where shadows of the scene fall.
    const auto spread = [&](int i) {
        const float t = 2.f * i / steps - 1;
        return reach * (0.3f * t + 0.7f * t * t * t);
    };
    Tessellation mesh;
    add_grid(mesh, steps, steps, [&](int r, int c, Vec3f& p, Vec3f& n) {
        p = {spread(c), 0, spread(r)};
        n = {0, 1, 0};
    });
    return mesh;
}

}  // namespace unravel::render
