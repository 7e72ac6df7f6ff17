#pragma once

// Where things are at the start: what the loader checks and the model starts from.

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "sim/mesh/start_line.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// The rotation about x, then y, then z (world axes) by angles in degrees.
Eigen::Matrix3d rotation_matrix(const Vec3& degrees);

/// (u, v) ∈ [0, 1]² of the particle at grid index (i, j). A tube's column i is at u = i / nu, as u = 1 is
/// u = 0 again; a direction of one particle has it in the middle, at 1/2.
Vec2 particle_uv(const Cloth& cloth, int i, int j);

/// How a cloth is turned: to where its front looks, then by its rotation.
Eigen::Matrix3d cloth_rotation(const Cloth& cloth);

/// Where a cloth's particles are at the start. What all have in common is worked out once.
class StartPlaces {
public:
    /// `cloth` must outlive it.
    explicit StartPlaces(const Cloth& cloth);

    /// Where the particle at (i, j) is placed [m], without jitter and wrinkles.
    Vec3 placed(int i, int j) const;
    /// Where it starts [m]: placed, and displaced by both along its normal.
    Vec3 started(int i, int j) const;
    /// No particle is displaced by more [m].
    double most_displaced() const;

private:
    struct Spot {
        Vec3 at, normal;  ///< before the cloth is turned and moved
    };
    Spot unrotated(int i, int j) const;

    const Cloth& cloth_;
    Eigen::Matrix3d rotation_;
    std::optional<StartLine> line_;  ///< of a sheet that does not lie flat
};

/// Where the particle is placed [m], without jitter.
Vec3 placed_particle(const Cloth& cloth, int i, int j);

/// As placed_particle(), all of them, at j · nu + i.
std::vector<Vec3> placed_particles(const Cloth& cloth);

/// Whether the particle `index` of a row is among `count` that are chosen evenly along it: its ends, and as
/// far as whole numbers allow equal distances between; of a ring equal ones all around. All where there are
/// no more of them, or `count` is 0.
bool evenly_chosen(int index, int particles, int count, bool ring);

/// Whether a pin catches the particle at (i, j); a mesh's vertex i is at (i, 0). One on the border of a box
/// or disc, to within 1e-9, is caught.
bool pin_catches(const Cloth& cloth, const Pin& pin, int i, int j);

/// Indices j · nu + i of the particles that a pin catches, ascending.
std::vector<std::size_t> pinned_particles(const Cloth& cloth, const Pin& pin);

/// The solid's own frame to the world at time 0: where its motion, if any, begins.
Eigen::Isometry3d start_pose(const Solid& solid);

}  // namespace unravel::sim
