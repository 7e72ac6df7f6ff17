#pragma once

#include "sim/run/simulate.hpp"

namespace unravel::sim {

/// One accepted step of a size chosen while running: the scene's step, halved as often as needed. A step is
/// rejected and undone exactly where the guard stops it, where it raises the largest strain by more than
/// `max_strain`, or where its local error h |Δv − Δv₀ h/h₀| / 2 (backward Euler's h² a'/2, from two steps'
/// changes of velocity) is above `tolerance`. After a calm step the size doubles again, where that meets the
/// grid of halvings: frames are always hit. Throws SimulationError where a step of the smallest size would
/// have to be rejected.
///   rate  1/s, of the scene's own steps
StepReport adaptive_step(Simulation& simulation, const AdaptiveStep& settings, double rate);

}  // namespace unravel::sim
