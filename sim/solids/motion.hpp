#pragma once

#include <Eigen/Geometry>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Rigid placement: local frame to world.
using Pose = Eigen::Isometry3d;

/// Rotation by degrees about x, then y, then z (world axes).
Eigen::Matrix3d rotation_from_degrees(const Vec3& degrees);

/// Displacement and rotation of a keyframed motion at time t. Monotone cubic between keyframes with zero
/// velocity at the first and the last, so that speed is continuous and keyframes are never overshot.
struct MotionSample {
    Vec3 displacement{0, 0, 0};  ///< m
    Vec3 degrees{0, 0, 0};
};
MotionSample sample_motion(const Motion& motion, double t);

/// Pose of a solid at time t: its own placement, turned about its pivot and displaced by its motion.
Pose solid_pose(const Solid& solid, double t);

/// The same rigid motion applied to a point of the world that rides on it: about `pivot`, from where it was
/// at t = 0.
Vec3 moved_point(const Motion& motion, const Vec3& pivot, const Vec3& start, double t);

}  // namespace unravel::sim
