#pragma once

// How what a scene places moves, and what it is repeated by (see scene.hpp for units and axes).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/scene/enums.hpp"

namespace unravel::sim {

using Vec3 = Eigen::Vector3d;

struct Keyframe {
    double time = 0;                                      ///< s
    Vec3 position{0, 0, 0};                               ///< m
    Vec3 rotation{0, 0, 0};                               ///< degrees about x, then y, then z (world axes)
    Interpolation interpolation = Interpolation::smooth;  ///< on the way to the next
};

/// Keyframed rigid motion: at rest before the first and after the last keyframe. Empty: does not move.
using Motion = std::vector<Keyframe>;

/// How a body falls from where it stands, and bounces.
struct Fall {
    double time = 0;              ///< s, when it is let go
    Vec3 velocity{0, 0, 0};       ///< m/s at that time
    std::optional<double> floor;  ///< m, height at which its lowest point is stopped; absent: nowhere
    double bounce = 0.5;          ///< share of its speed that it keeps in each bounce
    double give = 0;              ///< m by which the floor yields in the first bounce
    Vec3 gravity{0, 0, 0};        ///< m/s²: the scene's, by the loader
    double drop = 0;              ///< m, of its lowest point above the floor when let go, by the loader
};

/// What stands in a row, or in a mirror, of one that is written.
struct Repeat {
    int count = 1;          ///< of them, the one that is written among them
    Vec3 spacing{0, 0, 0};  ///< m, from each to the next
    Mirror mirror =
        Mirror::none;  ///< another one beyond the plane through the world's origin across this axis
};

}  // namespace unravel::sim
