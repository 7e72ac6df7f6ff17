#pragma once

#include <vector>

#include "sim/mesh/mesh_tree.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Signed distance [m] from a point to a solid's surface, negative inside, and its gradient (the outward unit
/// normal of the nearest surface point). `local` is in the solid's own frame: centre at the origin,
/// unrotated.
///
/// The distance is exact for every shape, so it is 1-Lipschitz. Where the nearest surface point is not unique
/// the gradient does not exist; then one of the nearest points' normals is given, always the same and always
/// of unit length:
///   sphere's centre                       +y
///   cylinder's and capsule's axis         +x  (nearest to the side), ±y (nearest to an end)
///   inside a box, between several faces   the first of x, y, z that is nearest; on a middle plane its + side
/// Of a mesh (as at t = 0, where it deforms) it is the direction to the nearest point of the surface.
/// On the edge of a sharp box or cylinder it is the normal of one of the faces that meet there.
double signed_distance(const Solid& solid, const Vec3& local, Vec3* gradient = nullptr);

/// A mesh that deforms, as it is at the beginning and at the end of a step.
struct DeformedSolid {
    MeshTree now, next;
    std::vector<Vec3> positions_now, positions_next;  ///< (vertices) in the solid's own frame [m]
    double t_next = -1;                               ///< s, that `next` stands for
    double moved = 0;                                 ///< m, the farthest that a vertex goes in the step
};

/// The surface nearest to a point of the solid's own frame, and where the material there goes.
struct SurfacePoint {
    double distance = 0;    ///< m, negative inside; beyond `cutoff` any lower bound above it
    Vec3 normal{0, 1, 0};   ///< unit, outward; not set beyond `cutoff`
    Vec3 carried{0, 0, 0};  ///< the point, had it ridden on that material to the step's other end [m]
};

/// `deformed` of the solid, or null for one that keeps its shape; `at_end` of the step or at its beginning.
SurfacePoint nearest_surface(const Solid& solid, const DeformedSolid* deformed, bool at_end,
                             const Vec3& local, double cutoff);

}  // namespace unravel::sim
