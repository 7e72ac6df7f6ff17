#pragma once

#include <cstdint>

namespace unravel::sim {

/// What solved a component of a step.
enum class SolvedBy : std::uint8_t { nothing, block, rows, aggregation, grid, multigrid };
inline constexpr std::uint8_t solver_count = 6;

/// Why that one did.
enum class SolveReason : std::uint8_t {
    nothing_implicit,
    one_row,
    asked,          ///< the scene's preconditioner or tolerance
    few_rows,       ///< fewer than pay for more
    on_no_grid,     ///< its cloth is a mesh, or it joins several cloths
    beyond_grid,    ///< coupled by more than a grid's springs
    sparse,         ///< covers little of its rows of the grid
    on_grid,        ///< one grid, large enough
    many_expected,  ///< expected iterations exceed what cycles cost
    took_over,      ///< another took longer than expected
    beyond_single,  ///< single precision could not reach the tolerance
};
inline constexpr std::uint8_t solve_reason_count = 11;

/// In words: "CG on rows", "it is part of one grid".
const char* words(SolvedBy solver);
const char* words(SolveReason reason);

}  // namespace unravel::sim
