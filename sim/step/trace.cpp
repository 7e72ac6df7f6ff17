#include "sim/step/trace.hpp"

#include "sim/step/stage.hpp"

namespace unravel::sim {

StepTrace trace_of(const ClothModel& model, const StepWorkspace& ws) {
    const LinearStage& linear = ws.linear;
    const bool staged = ws.plan.step.way == StepPlan::Way::coupled;
    ForcesAt at = forces_at(ws);
    if (!staged) {  // substeps leave no stage behind
        at = {};
        at.settings = ws.plan.step.forces.settings;
        at.x = ws.before.x;
        at.v = ws.before.v;
    }
    return {ws.plan.step,
            ws.before,
            ws.stage.h,
            linear.coupled,
            at,
            ws.forces.memory,
            ws.constraints,
            linear.components,
            linear.solves,
            ws.forces.memory.springs.state,
            linear.dv,
            {inertia_of(model, ws), linear.impulse, linear.drift},
            staged ? couplings_of(model, ws) : StepCouplings(),
            linear.system,
            linear.grids};
}

std::vector<Vec3> spring_forces(const ClothModel& model, const StepTrace& trace) {
    const ForcesAt& at = trace.forces_at;
    ExtensionForces forces;
    extension_forces(model.springs, model.mass, at.x, at.v, at.settings.h, at.settings.splitting,
                     at.settings.band, forces, at.taut, at.ahead);
    return forces.force;
}

}  // namespace unravel::sim
