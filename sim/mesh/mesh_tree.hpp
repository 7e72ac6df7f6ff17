#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Exact signed distance to a closed triangle mesh: a binary tree of boxes finds the nearest triangle, and
/// the angle-weighted pseudonormal of the feature that is nearest (face, edge or vertex) tells inside from
/// outside (Bærentzen & Aanæs, "Signed distance computation using the angle weighted pseudonormal", 2005).
class MeshTree {
public:
    MeshTree() = default;
    /// The tree's shape follows from these positions alone; `triangles` must be a closed, consistently
    /// oriented mesh that looks outward.
    MeshTree(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles);

    /// The same triangles elsewhere: boxes and normals are made anew, the tree keeps its shape.
    void refit(std::span<const Vec3> positions);

    struct Nearest {
        double distance = 0;         ///< m, negative inside
        Vec3 normal{0, 1, 0};        ///< unit, out of the body: the distance's gradient
        std::uint32_t triangle = 0;  ///< that the nearest point lies on
        Vec3 weights{1, 0, 0};       ///< its barycentric coordinates there
    };
    /// The surface point nearest to x. Where several are equally near it is always the same one. Where x is
    /// farther than `cutoff` from the box around the body, that distance is given and the rest is not set.
    Nearest nearest(const Vec3& x, double cutoff) const;

    const std::array<std::uint32_t, 3>& triangle(std::uint32_t t) const { return triangles_[t]; }
    bool empty() const { return triangles_.empty(); }
    /// Box around everything. [m]
    Vec3 low() const { return nodes_.front().low; }
    Vec3 high() const { return nodes_.front().high; }

private:
    struct Node {
        Vec3 low, high;
        std::uint32_t first, count;  ///< leaf: triangles; inner: count 0, children at first and first + 1
    };
    void make_features();

    std::vector<Node> nodes_;  ///< children follow their parents
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::array<std::uint32_t, 3>> edge_of_;  ///< (triangles) numbers of their edges
    std::vector<Vec3> positions_, face_normals_, edge_normals_, vertex_normals_;
};

}  // namespace unravel::sim
