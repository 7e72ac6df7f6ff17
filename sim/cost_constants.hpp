#pragma once

namespace unravel::cost {

// What particles cost on one thread [ns]. Only their ratios matter. These are estimates from runs of the
// single kernels on a busy machine, not yet measurements of whole steps: to be replaced by measured ones.

inline constexpr double swept_substep = 16;      ///< explicit, fused over a grid: per particle and substep
inline constexpr double swept_step = 60;         ///< what a swept step costs besides: per particle
inline constexpr double turned_substep = 500;    ///< explicit, spring by spring: per particle and substep
inline constexpr double coupled_step = 700;      ///< forces, graph, assembly: per particle
inline constexpr double coupled_iteration = 60;  ///< conjugate gradients: per particle and iteration

/// Iterations of the preconditioned conjugate gradients for each substep that explicit treatment would need:
/// both grow as the square root of the system's condition (11 substeps go with 29 iterations, 22 with 60).
inline constexpr double iterations_per_substep = 2.7;
/// Beyond so many, multigrid takes over and costs about as much (sim/solve_components.cpp).
inline constexpr double most_iterations = 70;

}  // namespace unravel::cost
