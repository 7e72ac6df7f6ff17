#pragma once

#include <vector>

#include "sim/step/step.hpp"

namespace unravel::sim {

/// Springs that swing, for tests of schemes: `duration` [s] of it.
struct Problem {
    ClothModel model;
    Placement start;
    double duration = 0;
};

inline constexpr int chain_masses = 9;
inline constexpr double chain_stiffness = 40, chain_mass = 0.1, chain_rest = 0.08, chain_gap = 0.1,
                        chain_swing = 0.01;
/// n equal masses between two walls on taut springs, moved along the line: x_k = k d + a sin(π k/(n+1)) cos
/// ωt, ω = 2 √(k_s/m) sin(π/(2(n+1))). All springs stay in extension, so that the forces are linear.
Problem chain();
/// Its particles at time t [m], in closed form.
std::vector<Vec3> chain_at(double t);
/// Two masses on two springs that swing as a double pendulum, stretched from the start and never slack, with
/// damping: nonlinear in position and velocity.
Problem pendulum();
/// A small sheet stretched by 8% in a fixed frame, sagging under gravity: the trampoline, every spring taut.
Problem trampoline();
/// A zigzag of taut springs with bend springs in compression from each particle to the next but one: bending
/// that never lets go, where what a scheme makes of it is seen.
Problem zigzag();

/// The forces' definition over the masses [m/s²], written down once more; none of pinned particles.
std::vector<Vec3> accelerations(const Problem& p, const std::vector<Vec3>& x, const std::vector<Vec3>& v);

/// With a solver whose error is far below the schemes'.
StepOptions options_of(Integrator integrator);
/// Where particles are at the end [m]. Step sizes follow `pattern` (relative), over and over, so many that
/// they fill the duration.
std::vector<Vec3> integrate(const Problem& p, const StepOptions& options, int steps,
                            const std::vector<double>& pattern = {1.0});
/// Root of the mean square [m].
double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

}  // namespace unravel::sim
