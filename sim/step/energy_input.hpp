#pragma once

#include "sim/step/step.hpp"

namespace unravel::sim {

/// Where the energy of a step just made, from ws.before to `after`, came from: what the guard
/// (sim/run/guard.hpp) lets it have.

/// J that pins, moving solids and forces (ForceTerm::put_in) have put into the cloth over the step; at least
/// 0 each, for what they take is friction's and the air's. Counted from what held and pushed each particle,
/// times how far it went; what does not act puts in nothing, wherever else it is. +∞ where something acted in
/// a step of several parts, which are not looked into, and where cloth touched cloth between surfaces.
double energy_input(const ClothModel& model, const ClothState& after, const StepReport& report,
                    StepWorkspace& ws);

/// J, at least 0, by which the energy of stretch and shear springs that are explicit swings in the step.
/// Forward–backward Euler keeps an energy that is h/2 v·f beside the true one, so that what seems to come
/// comes back: over the step it is ForceTerm::explicit_gain less the ½ m |Δv|² that every such step loses.
/// What the linearised forces of implicit springs add is in neither. 0 for multistep schemes, and where
/// nothing is coupled.
double energy_swing(const ClothModel& model, const ClothState& after, StepWorkspace& ws);

}  // namespace unravel::sim
