#pragma once

#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Stretch and shear springs (sim/forces/extension.hpp).
extern const ForceTerm spring_term;

}  // namespace unravel::sim
