#pragma once

#include <span>
#include <vector>

#include "sim/surface/surface_tree.hpp"

namespace unravel::sim {

/// An edge that passes through a triangle.
struct Crossing {
    std::uint32_t edge = 0, triangle = 0;
    friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

/// Whether edge pq passes through triangle abc, of which it shares no corner. Decided by signs of volumes,
/// each evaluated in one order of its corners whoever asks, a volume of zero counting as positive: an edge
/// that meets a surface exactly on the seam of two triangles passes through one of them, never through both
/// or none.
///   particles   p, q, a, b, c, all different;   x   where they are [m]
bool passes_through(const std::array<std::uint32_t, 5>& particles, const std::array<Vec3, 5>& x);

/// All crossings of a surface with itself, sorted. Knows nothing of contact: it is what contact is judged by.
/// The tree's boxes are made anew.
///   x   (particles) [m]
std::vector<Crossing> find_crossings(const Surface& surface, std::span<const Vec3> x, SurfaceTree& tree);

/// Where an edge meets a triangle's plane. [m]
Vec3 place_of(const Surface& surface, std::span<const Vec3> x, const Crossing& crossing);

}  // namespace unravel::sim
