#include "sim/step/choose_integrator.hpp"

#include <algorithm>

#include "sim/step/cost_constants.hpp"
#include "sim/sweep/explicit_sweep.hpp"

namespace unravel::sim {

IntegratorCosts count_costs(const ClothModel& model, const StepOptions& options, double h,
                            PlanMemory& memory) {
    StepOptions dividing = options;
    dividing.integrator = Integrator::explicit_;
    dividing.substeps = 0;
    IntegratorCosts costs;
    costs.substeps = substeps_of(model, dividing, h, memory);
    costs.swept = options.sweep && why_not_swept(model).empty();
    const double substep = !costs.swept ? cost::turned_substep
                                        : cost::swept_substep + (model.may_touch ? cost::swept_contact : 0.0);
    costs.explicit_cost = (costs.swept ? cost::swept_step : 0.0) + costs.substeps * substep;
    const double iterations = std::min(costs.substeps * cost::iterations_per_substep, cost::most_iterations);
    costs.coupled_cost = cost::coupled_step + (model.may_touch ? cost::coupled_contact : 0.0) +
                         iterations * cost::coupled_iteration;
    return costs;
}

}  // namespace unravel::sim
