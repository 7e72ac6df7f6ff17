#pragma once

#include "sim/model/failure.hpp"
#include "sim/model/model.hpp"
#include "sim/model/report.hpp"
#include "sim/step/workspace.hpp"

namespace unravel::sim {

/// Starts a state from where the scene places the cloth.
ClothState initial_state(const Placement& placement);

/// The plan of steps of h seconds: made anew where something has changed since it was last asked for.
const StepPlan& plan_step(const ClothModel& model, const StepOptions& options, double h, StepWorkspace& ws);

/// Advances the state by h seconds; ws.before is then what it was. Throws SimulationError where a velocity
/// would not be finite; the state is then what it was before. Throws Stopped where options.solve.stop asks.
StepReport step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                StepWorkspace& ws);

}  // namespace unravel::sim
