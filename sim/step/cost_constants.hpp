#pragma once

namespace unravel::sim::cost {

// What particles cost on one thread [ns]; only their ratios matter. Measured on scenes/hang.toml, which has
// air and bending, at 2,601, 10,201 and 40,401 particles: 36 to 38 per substep; 296, 357 and 361 for all of a
// coupled step but its solve; 9 to 11 per iteration with blocks; 446 for a solve by multigrid, set-up
// included. Contact on scenes/drape_sphere.toml at 10,000 and 40,000, half a second in, most of the cloth
// near the sphere: 100 per substep, 110 to 130 in a coupled step and about 50 more in its assembly.

inline constexpr double swept_substep = 36;  ///< explicit, fused over a grid: per particle and substep
inline constexpr double swept_contact = 80;  ///< contact in a substep, where there are solids; less where far
inline constexpr double swept_step = 40;     ///< what a swept step costs besides: per particle
inline constexpr double turned_substep = 500;    ///< explicit, spring by spring; an estimate
inline constexpr double coupled_step = 350;      ///< forces, graph, assembly: per particle
inline constexpr double coupled_contact = 160;   ///< what contact adds to that where there are solids
inline constexpr double coupled_iteration = 10;  ///< conjugate gradients: per particle and iteration

/// Iterations of the preconditioned conjugate gradients for each substep that explicit treatment would need:
/// both grow as the square root of the system's condition (6 substeps go with 16 iterations, 12 with 33).
inline constexpr double iterations_per_substep = 2.7;
/// Beyond so many, multigrid takes over and costs about as much (sim/step/solve_components.cpp).
inline constexpr double most_iterations = 45;

}  // namespace unravel::sim::cost
