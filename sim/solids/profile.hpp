#pragma once

#include <functional>
#include <vector>

#include "sim/solids/shape.hpp"

namespace unravel::sim {

/// Adds a (rows + 1) × (columns + 1) grid of vertices; `point(row, column, position, normal)` sets them.
void add_grid(ShapeSurface& surface, int rows, int columns,
              const std::function<void(int, int, Eigen::Vector3f&, Eigen::Vector3f&)>& point);

/// A point of a profile turned around y: distance from the axis, height [m], and the normal's two parts.
struct ProfilePoint {
    float radius, y, normal_radial, normal_y;
};

/// Adds an arc around (centre, y) from polar angle `from` to `to`, measured from +y [radians].
void add_arc(std::vector<ProfilePoint>& profile, float centre, float y, float radius, float from, float to,
             int segments);

/// A profile, from top to bottom, turned around y.
ShapeSurface turn(const std::vector<ProfilePoint>& profile, int sectors);

/// Sectors of a full turn that look round at a detail of 1.
inline int sectors_of(float detail) {
    return static_cast<int>(72 * detail);
}

}  // namespace unravel::sim
