#pragma once

#include <array>
#include <cstdint>

namespace unravel::sim {

/// Springs of one direction over a grid cloth, in grid order and without gaps: from `first` on, row after
/// row. Spring (i, j) joins particles (i, j) + from and (i, j) + to of the grid, columns modulo nu in a tube.
struct SpringRows {
    std::uint32_t first = 0;
    std::uint32_t per_row = 0;  ///< springs along u; 0: none of this direction
    std::uint32_t rows = 0;     ///< rows of springs along v
    std::array<std::uint32_t, 2> from{0, 0}, to{0, 0};
    std::uint32_t count() const { return per_row * rows; }
    std::uint32_t at(std::uint32_t i, std::uint32_t j) const { return first + j * per_row + i; }
};

/// Where a grid cloth's springs stand in the model's lists (`springs`, and for bending `bends`), so that a
/// kernel finds them by stencil, with no index read:
///
///   u         (i, j) — (i+1, j)        bend_u         (i, j) — (i+2, j)
///   v         (i, j) — (i, j+1)        bend_v         (i, j) — (i, j+2)
///   diagonal  (i, j) — (i+1, j+1)      bend_diagonal  (i, j) — (i+2, j+2)
///   anti      (i+1, j) — (i, j+1)      bend_anti      (i+2, j) — (i, j+2)
///
/// The lists keep i < j for every spring. So in a tube the springs along u that close the ring (the last of
/// each row of u, the last two of bend_u) are stored from `to` to `from`; all others as drawn. Shear and
/// bend springs are either there for the whole cloth, some perhaps of zero stiffness, or not at all.
///
/// Where bending goes by curvature (`curvature` is its list; sim/forces/curvature.hpp), bend_u and bend_v are
/// the arcs between neighbours, and there are, beginning at (i, j),
///
///   curve_u   (i, j), (i+1, j), (i+2, j)      twist     (i, j), (i+1, j), (i+1, j+1), (i, j+1)
///   curve_v   (i, j), (i, j+1), (i, j+2)
struct GridSprings {
    std::uint32_t particle = 0;    ///< the grid's first; particle (i, j) is particle + j·nu + i
    std::uint32_t nu = 0, nv = 0;  ///< particles along u and v
    bool tube = false;             ///< closed in u
    SpringRows u, v, diagonal, anti;
    SpringRows bend_u, bend_v, bend_diagonal, bend_anti;
    SpringRows curve_u, curve_v, twist;
    std::uint32_t count() const { return nu * nv; }
    std::uint32_t at(std::uint32_t i, std::uint32_t j) const {
        return particle + j * nu + (tube && i >= nu ? i - nu : i);
    }
};

/// Whether the grid's arcs join neighbours along threads.
inline bool arcs_between_neighbours(const GridSprings& grid) {
    return grid.bend_u.to[0] == 1 || grid.bend_v.to[1] == 1;
}

}  // namespace unravel::sim
