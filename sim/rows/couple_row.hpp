#pragma once

#include <cstddef>

#include "sim/rows/sweep_row.hpp"

namespace unravel::sim {

/// One end of a family's springs along a row: what the linear system (Eq. 5) needs to know of particles.
struct RowEnd {
    ConstRow x;          ///< m, where springs are linearised
    ConstRow drift;      ///< m, how far the particles move without the solve
    const double* ours;  ///< 1 for particles of the component, else 0
    const double* mass;  ///< kg
    RowEnd from(std::ptrdiff_t column) const {
        const auto shifted = [&](const ConstRow& row) {
            return ConstRow{row[0] + column, row[1] + column, row[2] + column};
        };
        return {shifted(x), shifted(drift), ours + column, mass + column};
    }
};

/// Blocks a I + w wᵀ of `count` springs that join column i of row a with column i of row b
/// (sim/kernels/grid_system.hpp), zero where a spring is not implicit or of no particle of ours; and what the
/// springs pull by without the solve, h K (g_b − g_a), added to fa and taken from fb [kg·m/s].
///   stiffness, damping, state  (springs)
///   arcs    (springs) slope of the push of an arc between the same ends, implicit too [N/m]; or null
///   blocks  number k of block i at [k·pitch + i]; or null
/// Returns the largest coupling over the lighter end's mass.
double couple_row(const RowEnd& a, const RowEnd& b, double rest, const double* stiffness,
                  const double* damping, const SpringState* state, const double* arcs, double h,
                  std::size_t count, const Row& fa, const Row& fb, float* blocks, std::ptrdiff_t pitch);

}  // namespace unravel::sim
