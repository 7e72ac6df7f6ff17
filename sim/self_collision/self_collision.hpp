#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/forces/extension.hpp"
#include "sim/model/model.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Particles that were near each other when pairs were searched, by boxes of a grid, and how they have moved
/// against each other since. Rooms between groups are a triangle of a matrix: of a and b ≤ a at a(a + 1)/2 +
/// b.
struct ParticleGroups {
    double edge = 0;                                           ///< m, of the boxes
    std::vector<std::pair<std::uint64_t, std::uint32_t>> key;  ///< (particles) box and particle, sorted
    std::vector<std::uint32_t> start;                          ///< (groups + 1) of `key`
    std::vector<Vec3> low, high;  ///< (groups) corners of the particles' own box [m]
    std::vector<Vec3> way;        ///< (groups) how far they have gone on the mean [m]
    std::vector<double> spread;   ///< (groups) and how far at most from that [m]
    std::vector<double> room;     ///< by how much two may come nearer before a pair is missing [m]
    std::size_t size() const { return start.empty() ? 0 : start.size() - 1; }
};

/// Cloth against cloth (paper Sec. 2.2; Zhang & Yuen 2000): particles that are no neighbours and nearer than
/// a thickness get a temporary stiff damped spring that pushes them apart. These springs enter the splitting
/// and the component graph like the cloth's own.
struct SelfCollisionWorkspace {
    ExtensionSprings springs;  ///< of this step; `rest` is the thickness
    ExtensionForces forces;
    Adjacency adjacency;
    double least_distance = 0;  ///< m, between particles that may collide; the thickness if none are nearer

    /// Pairs near enough to matter within a while, found by voxels; reused until others may have come near.
    std::vector<std::uint64_t> pairs;     ///< i · 2³² + j, i < j, sorted
    double searched = 1.5, farthest = 6;  ///< thicknesses out to which they are looked for, and may be
    std::vector<Vec3> x_searched;         ///< (particles) where they were then [m]
    std::vector<std::uint32_t> voxel_start, voxel_particles, voxel_of;
    std::vector<std::vector<std::uint64_t>> found;  ///< (chunks of particles) pairs
    ParticleGroups groups;                          ///< that move much alike, as they were then
};

/// Finds the step's pairs at (x, v), split by κ ≤ threshold. Memory is kept between steps.
void self_collide(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> v, double h,
                  double threshold, SelfCollisionWorkspace& ws);

/// Whether two particles may never collide: near neighbours on the same cloth, or nearer than the thickness
/// when flat.
bool are_neighbours(const ClothModel& model, std::uint32_t p, std::uint32_t q);

}  // namespace unravel::sim
