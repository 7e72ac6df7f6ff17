#pragma once

#include <algorithm>
#include <string>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Moduli of a cloth of threads and diagonals. In a cell of a × b the diagonals of shear modulus G resist
/// stretch along u by 2 G (a/b)², along v by 2 G (b/a)², and one by the other by 2 G. The threads' springs
/// are weaker by as much, so that of cells of any shape
///
///   stretch   is the modulus of cloth that is held in its width: C_uu, C_vv;
///   shear     is the shear modulus, G;
///   C_uv      is 2 G: stretched alike both ways, cloth resists by stretch + 2 G along each.
///
/// A strip that is free to narrow does so as a trellis, since threads don't resist to be pushed together: its
/// modulus is that of the threads, stretch − 2 G (a/b)². They keep at least half; where cells are so oblong,
/// or stretch is so small beside shear, that this would leave less, the diagonals are weaker instead.

/// Least share of `stretch` that the threads have.
inline constexpr double threads_share = 0.5;

/// The share of the shear modulus that diagonals have in a cell of (a/b)² = square: 1 where threads bear it.
inline double diagonals_share(const Material& material, double square) {
    const double most =
        0.5 * (1 - threads_share) * std::min(material.stretch[0] / square, material.stretch[1] * square);
    return material.shear > most ? most / material.shear : 1.0;
}

/// What is told of a cloth whose diagonals have only such a share in some cells.
std::string weak_shear_note(const Cloth& cloth, double least_share, const std::string& cells);

}  // namespace unravel::sim
