#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Triangles of a shape's surface in its own frame, counter-clockwise from outside, for what has to see it.
struct ShapeSurface {
    std::vector<Eigen::Vector3f> positions, normals;  ///< (vertices) [m], unit
    std::vector<std::uint32_t> indices;               ///< (triangles × 3)
};

/// Which of a Solid's sizes a shape is made of.
struct ShapeSizes {
    bool radius = false, height = false, size = false, round = false;
};

/// All that there is to know of a shape. Each is a file of its own beside this one and a line in all_shapes.
/// What they are given is in the solid's own frame: its centre at the origin, unrotated.
struct ShapeLaw {
    ShapeSizes sizes;
    /// Signed distance [m], exact; sets the outward normal as signed_distance() says.
    double (*distance)(const Solid& solid, const Vec3& local, Vec3& normal);
    /// Of the smallest box about its centre, along its axes [m]; infinite where it has no end.
    Vec3 (*half_extents)(const Solid& solid);
    /// Of the smallest ball about its centre [m].
    double (*reach)(const Solid& solid);
    /// Radius of its tightest rounding [m]; 0: it has edges. Null: a plane, or a mesh.
    double (*rounding)(const Solid& solid);
    /// Its surface, fine enough to look round at 1080p where `detail` is 1; less gives coarser, inscribed
    /// shapes. Null: a plane has no end, and a mesh has triangles of its own.
    ShapeSurface (*surface)(const Solid& solid, float detail);
};

extern const ShapeLaw plane_shape, sphere_shape, box_shape, cylinder_shape, capsule_shape, mesh_shape;

/// In the order of the enum.
inline constexpr const ShapeLaw* all_shapes[] = {&plane_shape,    &sphere_shape,  &box_shape,
                                                 &cylinder_shape, &capsule_shape, &mesh_shape};

inline const ShapeLaw& law_of(Shape shape) {
    return *all_shapes[static_cast<std::size_t>(shape)];
}

}  // namespace unravel::sim
