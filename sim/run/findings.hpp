#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/model/model.hpp"
#include "sim/model/report.hpp"

namespace unravel::sim {

/// What pictures of a run may hide and a user would want to know of it, a sentence each. What was not right:
/// strain above 20% with its time and place, cloth that passes through cloth or solids, contacts that hold
/// what they should let go, steps that ended short of their tolerance or were taken again, wind that explicit
/// steps did not bear. And what may not be meant: cloth that moves at the end though nothing drives it,
/// effects that had nothing to do. Empty where nothing of the kind was.
///   reports   of all steps, in order
std::vector<std::string> findings(const Scene& scene, const ClothModel& model,
                                  std::span<const StepReport> reports);

}  // namespace unravel::sim
