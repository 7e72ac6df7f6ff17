#pragma once

#include <nlohmann/json.hpp>

#include "tool/base/names.hpp"
#include "tool/inspect/inspected.hpp"

namespace unravel::tool {

/// The step in numbers: counts, solve, components.
nlohmann::ordered_json step_numbers(const InspectedStep& step);

/// All about one particle, one spring. Throws UsageError where there is none of that number.
nlohmann::ordered_json particle_numbers(const InspectedStep& step, std::int64_t particle);
nlohmann::ordered_json spring_numbers(const InspectedStep& step, std::int64_t spring);

const char* spring_state_name(SpringState state);

}  // namespace unravel::tool
