#pragma once

#include "tool/base/names.hpp"
#include "tool/bench/measured_problem.hpp"

namespace unravel::tool {

/// Every way to solve the problem's captured system to its tolerance, repetitions interleaved, and what a row
/// and iteration costs each. Direct solvers are left out beyond what memory bears, and every way that would
/// take longer than what is left of the allowance.
void measure_solves(MeasuredProblem& problem, const SpeedPlan& plan, const SpeedBench& smaller,
                    const Allowance& allowance, SizeRecord& record);

}  // namespace unravel::tool
