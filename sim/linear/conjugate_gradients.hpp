#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/stop.hpp"

namespace unravel::sim {

/// Preconditioned conjugate gradients (Hestenes & Stiefel 1952) on what `problem` holds: x, r = b − A x, q, a
/// direction p and a preconditioner M. It stops when the residual is no larger than `target`, `iterations`
/// reaches `until`, or rounding leaves no direction to go; returns the last residual. Throws Stopped.
///   double precondition()          z = M⁻¹ r; r·z
///   double multiply(double beta)   p = z + β p, or z where β = 0; q = A p; p·q
///   double measure(double alpha)   x += α p, r −= α q; ‖r‖² in the stopping rule's norm
/// What two of these do to a row may be done in one go, whenever its result is asked for.
///   residual    ‖r‖² of the start
///   iterations  counts on from what it is
template <typename Problem>
double conjugate_gradients(Problem& problem, double residual, double target, std::uint32_t until,
                           std::uint32_t& iterations, StopFlag stop = nullptr) {
    double before = 0;
    while (residual > target && iterations < until) {
        heed(stop);
        const double rho = problem.precondition();
        if (!(rho > 0)) break;
        const double curvature = problem.multiply(before > 0 ? rho / before : 0.0);
        ++iterations;
        if (!(curvature > 0)) break;
        residual = problem.measure(rho / curvature);
        before = rho;
    }
    return residual;
}

/// Iterations with blocks that a component is expected to take. They grow with the distance that a spring's
/// pull travels within a step, `reach` = √κ springs, as long as the component is larger than that; fitted to
/// hanging and draped sheets.
inline double expected_iterations(double reach, std::size_t rows) {
    return 6.0 * std::pow(std::min(reach, std::sqrt(static_cast<double>(rows))), 0.75);
}

/// What solving a component by cycles of a multigrid costs, set-up included, in iterations with blocks: from
/// here on `automatic` begins with cycles.
inline constexpr std::uint32_t iterations_worth_cycles = 60;
/// Cycles after which they give way to blocks.
inline constexpr std::uint32_t most_cycles_of_multigrid = 60;

}  // namespace unravel::sim
