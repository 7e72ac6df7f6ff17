#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/forces/grid_springs.hpp"
#include "sim/kernels/grid_cg.hpp"
#include "sim/linear/solve.hpp"
#include "sim/model/model.hpp"

namespace unravel::sim {

/// Rows from which the grid's solver is the faster one.
inline constexpr std::uint32_t least_rows_on_grid = 256;
/// Whether the options leave components to the grid's solver.
bool may_use_grids(const SolveOptions& options);

/// What solves each component of a step: rows in double (sim/linear/solve.hpp), or, for a large one that lies
/// on a grid and has no springs but the grid's and no stencils but those of its bending, the grid's own
/// solver in single precision (sim/kernels/grid_cg.hpp). Chosen from the system alone, so that the same input
/// gives the same bits.
struct SolvePlan {
    struct OnGrid {
        std::uint32_t component;
        const GridSprings* springs;
    };
    std::vector<OnGrid> on_grid;
    std::vector<std::uint8_t> elsewhere;  ///< (components) 1: on a grid; empty: none is
    std::vector<SolveReason> because;     ///< (components) why there or not; empty: no grid was considered
};

/// The components that are solved on grids, and what that takes; kept between steps for its memory.
struct GridSolves {
    SolvePlan plan;
    struct Grid {
        GridSystem system;
        GridCgWorkspace cg;
        ComponentSolve solve;
        bool solved = false;
    };
    std::vector<std::unique_ptr<Grid>> grids;  ///< one per component solved on a grid
    std::vector<std::uint8_t> beyond;          ///< (components) 1: coupled by more than a grid's springs
};

/// What a step's linear system is made of.
struct StepSystem {
    std::span<const GridSprings> grids;  ///< of the cloths; may be empty
    Couplings couplings;                 ///< the cloths' springs first
    const Load& load;
    const Components& components;
    const Constraints& constraints;
    std::span<const Vec3> guess;         ///< (particles) y, from which the solve starts [m/s]
    double h;                            ///< s
    const Stitches* stitches = nullptr;  ///< of the cloths, which aggregates reach across
};

/// Plans which solver each component gets and assembles A and b (Eq. 5) for it: rows in `rows`, which for a
/// component that is solved on a grid holds those of its constrained particles only.
void assemble_components(const StepSystem& step, const SolveOptions& options, GridSolves& grids,
                         System& rows);

/// Solves what assemble_components() left, under the constraints (Eq. 9), each component a task of its own:
/// the largest first and in parallel inside, the small ones in the gaps that they leave. Δv in ws.x, (rows).
///   out   (components)
void solve_components(const StepSystem& step, const SolveOptions& options, GridSolves& grids, System& rows,
                      SolveWorkspace& ws, std::vector<ComponentSolve>& out);

}  // namespace unravel::sim
