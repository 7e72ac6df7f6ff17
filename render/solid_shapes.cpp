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

/// A point of a profile turned around y: distance from the axis, height, and the normal's two parts.
struct ProfilePoint {
    float radius, y, normal_radial, normal_y;
};

/// Profile from top to bottom.
Tessellation turn(const std::vector<ProfilePoint>& profile, int sectors) {
    Tessellation mesh;
    add_grid(mesh, static_cast<int>(profile.size()) - 1, sectors, [&](int r, int c, Vec3f& p, Vec3f& n) {
        const ProfilePoint& at = profile[r];
        const float angle = 2 * pi * c / sectors, x = std::sin(angle), z = std::cos(angle);
        p = {at.radius * x, at.y, at.radius * z};
        n = {at.normal_radial * x, at.normal_y, at.normal_radial * z};
    });
    return mesh;
}

/// Arc of the profile around (centre, y) from polar angle `from` to `to`, measured from +y.
void add_arc(std::vector<ProfilePoint>& profile, float centre, float y, float radius, float from, float to,
             int segments) {
    for (int i = 0; i <= segments; ++i) {
        const float angle = from + (to - from) * i / segments, s = std::sin(angle), c = std::cos(angle);
        profile.push_back({centre + radius * s, y + radius * c, s, c});
    }
}

Tessellation tessellate_cylinder(const SolidMesh& solid, int sectors) {
    const float half = 0.5f * solid.height, round = std::min({solid.round, solid.radius, half});
    std::vector<ProfilePoint> profile;
    const float flat = solid.radius - round;
    for (const float t : {0.f, 0.3f, 0.6f, 0.85f, 1.f}) profile.push_back({flat * t, half, 0, 1});
    add_arc(profile, flat, half - round, round, 0, pi / 2, 6);
    for (int i = 1; i < 16; ++i) profile.push_back({solid.radius, (half - round) * (1 - i / 8.f), 1, 0});
    add_arc(profile, flat, round - half, round, pi / 2, pi, 6);
    for (const float t : {1.f, 0.85f, 0.6f, 0.3f, 0.f}) profile.push_back({flat * t, -half, 0, -1});
    return turn(profile, sectors);
}

Tessellation tessellate_capsule(const SolidMesh& solid, int sectors) {
    const float half = 0.5f * solid.height;
    std::vector<ProfilePoint> profile;
    add_arc(profile, 0, half, solid.radius, 0, pi / 2, sectors / 4);
    for (int i = 1; i < 16; ++i) profile.push_back({solid.radius, half * (1 - i / 8.f), 1, 0});
    add_arc(profile, 0, -half, solid.radius, pi / 2, pi, sectors / 4);
    return turn(profile, sectors);
}

Tessellation tessellate_box(const SolidMesh& solid, int straight) {
    const Vec3f half = 0.5f * solid.size;
    const float round = std::clamp(solid.round, 0.f, half.minCoeff());
    // Along each axis of a face: an arc at either end and straight steps between, as signed offsets.
    constexpr int arc = 4;
    const int steps = 2 * arc + straight;
    const auto along = [&](int i,
                           float half_length) -> std::pair<float, float> {  // (inner point, tangent of tilt)
        const float inner = half_length - round;
        if (i < arc) return {-inner, -std::tan(pi / 4 * (arc - i) / arc)};
        if (i > arc + straight) return {inner, std::tan(pi / 4 * (i - arc - straight) / arc)};
        return {inner * (2.f * (i - arc) / straight - 1), 0.f};
    };
    Tessellation mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.f, 1.f}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            add_grid(mesh, steps, steps, [&](int r, int c, Vec3f& p, Vec3f& n) {
                // Swapping rows and columns on one side keeps triangles counter-clockwise from outside.
                const auto [pu, nu] = along(side > 0 ? r : c, half[u]);
                const auto [pv, nv] = along(side > 0 ? c : r, half[v]);
                n[axis] = side;
                n[u] = round > 0 ? nu : 0;
                n[v] = round > 0 ? nv : 0;
                n.normalize();
                p[axis] = side * (half[axis] - round);
                p[u] = pu;
                p[v] = pv;
                p += round * n;
            });
        }
    return mesh;
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

Tessellation tessellate(const SolidMesh& solid, float detail) {
    const int sectors = static_cast<int>(72 * detail);
    switch (solid.shape) {
        case SolidShape::plane:
            return {};
        case SolidShape::sphere: {
            std::vector<ProfilePoint> profile;
            add_arc(profile, 0, 0, solid.radius, 0, pi, sectors / 2);
            return turn(profile, sectors);
        }
        case SolidShape::box:
            return tessellate_box(solid, static_cast<int>(12 * detail));
        case SolidShape::cylinder:
            return tessellate_cylinder(solid, sectors);
        case SolidShape::capsule:
            return tessellate_capsule(solid, sectors);
        case SolidShape::mesh:
            return tessellate_mesh(crease(solid.triangles, solid.positions), solid.positions);
    }
    return {};
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
