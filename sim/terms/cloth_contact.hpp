#pragma once

#include "sim/self_collision/self_collision.hpp"
#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Cloth against cloth by temporary springs (sim/self_collision/).
extern const ForceTerm self_collision_term;

}  // namespace unravel::sim
