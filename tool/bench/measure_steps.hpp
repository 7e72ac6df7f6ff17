#pragma once

#include <array>
#include <utility>

#include "tool/base/names.hpp"
#include "tool/bench/measured_problem.hpp"

namespace unravel::tool {

/// The stages of a step, by name, in their order.
inline constexpr std::array<std::pair<const char*, double StageTimes::*>, 8> step_stages{
    {{"contact", &StageTimes::contact},
     {"self-collision", &StageTimes::collision},
     {"air", &StageTimes::air},
     {"forces", &StageTimes::forces},
     {"graph", &StageTimes::graph},
     {"assembly", &StageTimes::assembly},
     {"solve", &StageTimes::solve},
     {"advance", &StageTimes::advance}}};

/// 1, 2, 4 … and `all`.
std::vector<int> thread_counts(int all);

/// Every way to step from the problem's state, repetitions interleaved so that a busy machine is busy for
/// all of them. Ways that would take longer than what is left of the allowance, by what smaller sizes took,
/// are left out.
void measure_steps(MeasuredProblem& problem, const SpeedPlan& plan, const SpeedBench& smaller,
                   const Allowance& allowance, SizeRecord& record);

}  // namespace unravel::tool
