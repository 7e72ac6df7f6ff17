#pragma once

#include <array>
#include <vector>

#include "sim/kernels/grid_system.hpp"
#include "sim/kernels/line_multigrid.hpp"
#include "sim/linear/solve.hpp"

namespace unravel::sim {

/// Memory of solve_on_grid(), kept between steps.
struct GridCgWorkspace {
    std::vector<float> r, z, q, d;
    std::array<std::vector<float>, 2> p;
    std::vector<double> dots;  ///< (grid rows)
    std::vector<double> bent;  ///< b − K x of bending; empty: none
    int nu = 0, nv = 0;        ///< the grid that they were made for
    LineMultigrid multigrid;
};

/// Below this tolerance single precision is not worth its restarts.
inline constexpr double grid_cg_tolerance = 1e-6;

/// Conjugate gradients on a component in grid form, in single precision with sums in double, preconditioned
/// by P (sim/kernels/grid_system.hpp) or by a multigrid cycle. The iterate is x plus a correction; when its
/// recursive residual meets the stopping rule of sim/linear/solve.hpp, the residual is evaluated anew in
/// double, and the iteration starts again from there unless that one meets it too. Sums run over rows of the
/// grid, in order: the same bits for any number of threads, and for any instruction set.
///
/// After `patience` iterations the other of the two takes over, once: a system that blocks would take long
/// for gets its multigrid after all; and where springs come and go so fast that coarse grids tell little of
/// the fine one, so that a cycle gains hardly more than an iteration with blocks, blocks go on.
///
/// False where the residual stalls above the tolerance: single precision can't reach it, nothing is returned.
bool solve_on_grid(GridSystem& system, bool multigrid, std::uint32_t patience, const SolveOptions& options,
                   GridCgWorkspace& ws, ComponentSolve& out);

}  // namespace unravel::sim
