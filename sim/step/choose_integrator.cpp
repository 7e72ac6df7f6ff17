#include "sim/step/choose_integrator.hpp"

#include <algorithm>

#include "sim/step/cost_constants.hpp"

namespace unravel::sim {

IntegratorCosts count_costs(const ClothModel& model, const StepOptions& options, double h,
                            StepWorkspace& ws) {
    StepOptions dividing = options;
    dividing.integrator = Integrator::explicit_;
    dividing.substeps = 0;
    IntegratorCosts costs;
    costs.substeps = substeps_of(model, dividing, h, ws);
    const double part = h / costs.substeps;
    limit_bend(model.bends, model.mass, part, ws.bend_limit);
    costs.swept = options.sweep && ws.sweep.prepare(model, ws.bend_limit, part);
    const bool touches = !model.solids.empty();
    const double substep =
        !costs.swept ? cost::turned_substep : cost::swept_substep + (touches ? cost::swept_contact : 0.0);
    costs.explicit_cost = (costs.swept ? cost::swept_step : 0.0) + costs.substeps * substep;
    const double iterations = std::min(costs.substeps * cost::iterations_per_substep, cost::most_iterations);
    costs.coupled_cost =
        cost::coupled_step + (touches ? cost::coupled_contact : 0.0) + iterations * cost::coupled_iteration;
    return costs;
}

StepOptions choose_integrator(const ClothModel& model, const StepOptions& options, double h,
                              StepWorkspace& ws) {
    if (ws.chosen_for != h) {
        ws.chosen = count_costs(model, options, h, ws).cheaper();
        ws.chosen_for = h;
    }
    StepOptions chosen = options;
    chosen.integrator = ws.chosen;
    chosen.substeps = 0;
    return chosen;
}

}  // namespace unravel::sim
