#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/model/model.hpp"
#include "sim/model/report.hpp"

namespace unravel::sim {

/// What pictures of a run may hide and a user would want to know of it, a sentence each: strain above 20%
/// with its time and place, cloth that passes through cloth or solids, contacts that hold what they should
/// let go. Empty where nothing of the kind was.
///   reports   of all steps, in order
std::vector<std::string> findings(const ClothModel& model, std::span<const StepReport> reports);

}  // namespace unravel::sim
