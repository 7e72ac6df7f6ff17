#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/step/plan.hpp"

namespace unravel::sim {

/// A plan in words: of the integrator, the steps, each force and each cloth its name and what is planned.
std::vector<std::pair<std::string, std::string>> plan_words(const StepPlan& plan);

/// A plan as data, as run.json keeps it.
nlohmann::ordered_json plan_json(const StepPlan& plan);

}  // namespace unravel::sim
