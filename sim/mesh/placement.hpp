#pragma once

// Where things are at the start: what the loader checks and the model starts from.

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// The rotation about x, then y, then z (world axes) by angles in degrees.
Eigen::Matrix3d rotation_matrix(const Vec3& degrees);

/// (u, v) ∈ [0, 1]² of the particle at grid index (i, j). A tube's column i is at u = i / nu, as u = 1 is
/// u = 0 again; a direction of one particle has it in the middle, at 1/2.
Vec2 particle_uv(const Cloth& cloth, int i, int j);

/// Where the particle is placed [m], without jitter.
Vec3 placed_particle(const Cloth& cloth, int i, int j);

/// Where it starts [m]: placed, and displaced by the cloth's jitter along its unrotated normal.
Vec3 started_particle(const Cloth& cloth, int i, int j);

/// As placed_particle(), all of them, at j · nu + i.
std::vector<Vec3> placed_particles(const Cloth& cloth);

/// Whether a pin catches the particle at (i, j); a mesh's vertex i is at (i, 0). One on the border of a box
/// or disc, to within 1e-9, is caught.
bool pin_catches(const Cloth& cloth, const Pin& pin, int i, int j);

/// Indices j · nu + i of the particles that a pin catches, ascending.
std::vector<std::size_t> pinned_particles(const Cloth& cloth, const Pin& pin);

/// The solid's own frame to the world at time 0: where its motion, if any, begins.
Eigen::Isometry3d start_pose(const Solid& solid);

}  // namespace unravel::sim
