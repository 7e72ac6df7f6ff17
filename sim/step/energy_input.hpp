#pragma once

#include "sim/step/step.hpp"

namespace unravel::sim {

/// J that pins, solids, wind and temporary springs (stitches that shrink, self-collision) have put into the
/// cloth over the step just made, from ws.before to `after`; at least 0 each, for what they take is friction's
/// and the air's. Counted from what held and pushed each particle, times how far it went; what does not act
/// puts in nothing, wherever else it is. +∞ where something acted that is not counted: in a step of several
/// parts, and where a particle was put back out of a solid.
double energy_input(const ClothModel& model, const ClothState& after, const StepReport& report,
                    StepWorkspace& ws);

}  // namespace unravel::sim
