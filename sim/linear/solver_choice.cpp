#include "sim/linear/solver_choice.hpp"

#include <array>

namespace unravel::sim {

const char* words(SolvedBy solver) {
    constexpr std::array<const char*, solver_count> names{
        "nothing",
        "its block",
        "CG on rows in double precision",
        "CG on rows with cycles by aggregation",
        "CG on the grid in single precision",
        "CG on the grid with cycles by lines",
    };
    return names[static_cast<std::uint8_t>(solver)];
}

const char* words(SolveReason reason) {
    constexpr std::array<const char*, solve_reason_count> names{
        "nothing is implicit",
        "it is one row",
        "solver.preconditioner or solver.tolerance asks for it",
        "it has few rows",
        "it is no part of one grid",
        "more than a grid's springs and stencils couples it",
        "it covers little of its rows of the grid",
        "it is a large part of one grid",
        "the other would need many iterations",
        "the other took longer than expected",
        "single precision could not reach the tolerance",
    };
    return names[static_cast<std::uint8_t>(reason)];
}

}  // namespace unravel::sim
