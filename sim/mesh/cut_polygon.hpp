#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// More corners than any tool writes on purpose; cutting takes their number's square.
inline constexpr std::size_t most_corners = 4096;

/// A piece of a polygon, by numbers of its corners; the last is no_index in a triangle.
using Piece = std::array<std::uint32_t, 4>;

/// Cuts a polygon, convex or not and not quite flat, into n − 2 triangles of which some are joined to quads:
/// nearly rectangular quads of four corners in a row are cut off first, then ears (Meisters 1975), the
/// best-shaped first, as seen along its mean normal. `corners` in order [m], at least three and at most
/// most_corners. A polygon that crosses itself is cut as well, into pieces that overlap.
std::vector<Piece> cut_polygon(std::span<const Vec3> corners);

/// Whether a polygon seen along its mean normal has no corner that turns the other way.
bool is_convex(std::span<const Vec3> corners);

}  // namespace unravel::sim
