#pragma once

#include <string>

#include "sim/model/model.hpp"

namespace unravel::sim {

/// A particle as messages name it: "particle 57 (u 6, v 3)", "particle 912 (vertex 101 of cloth 1)".
std::string particle_name(const ClothModel& model, std::uint32_t p);

}  // namespace unravel::sim
