#pragma once

#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Seams that close: damped springs that shrink to nothing, and pull only.
extern const ForceTerm stitch_term;

/// Empty where no mesh has seams.
struct StitchMemory {
    ExtensionSprings springs;  ///< `rest` is that of the step's end
    ExtensionForces forces;
    Adjacency adjacency;
};

}  // namespace unravel::sim
