#pragma once

#include <Eigen/Geometry>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Rigid placement: local frame to world.
using Pose = Eigen::Isometry3d;

/// Rotation by degrees about x, then y, then z (world axes).
Eigen::Matrix3d rotation_from_degrees(const Vec3& degrees);

/// Displacement and rotation of a keyframed motion at time t, between keyframes as each of them says: on a
/// monotone cubic with zero velocity at the first and the last, so that speed is continuous and keyframes are
/// never overshot (smooth), on a straight line (linear), where the earlier one is (hold), or from rest to
/// rest (ease, 3s² − 2s³).
struct MotionSample {
    Vec3 displacement{0, 0, 0};  ///< m
    Vec3 degrees{0, 0, 0};
};
MotionSample sample_motion(const Motion& motion, double t);

/// How far a body that falls has come at time t [m]: free flight, and where it meets the floor a bounce that
/// leaves `bounce` of its speed. Where the floor gives, it is a spring without weight on which the body
/// swings half a period, softer on the way up, so that its speed is continuous. A bounce lower than a
/// millimetre ends it.
Vec3 fallen(const Fall& fall, double t);

/// Pose of a solid at time t: its own placement, turned about its pivot and displaced by its motion and its
/// fall, and carried by what it rides on.
Pose solid_pose(const Solid& solid, double t);

/// From where something that is carried was at the start to where it is at time t; the identity where nothing
/// carries it.
Pose carried_pose(const Carried& carried, double t);

/// The same of what rides on another triangle of a body that deforms, of which the vertices at time t are
/// given, as positions_at() has them.
Pose ride_on_triangle(const Solid& body, int triangle, const std::vector<Vec3>& surface, double t);

/// The triangle of a mesh that deforms on which what stands at a point of the world at the start rides: the
/// nearest one. −1 of a body that keeps its shape.
int carrying_triangle(const Solid& body, const Vec3& point);

/// The same rigid motion applied to a point of the world that rides on it: about `pivot`, from where it was
/// at t = 0.
Vec3 moved_point(const Motion& motion, const Vec3& pivot, const Vec3& start, double t);

}  // namespace unravel::sim
