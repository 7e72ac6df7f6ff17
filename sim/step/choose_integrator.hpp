#pragma once

#include "sim/step/explicit_limit.hpp"
#include "sim/step/step.hpp"

namespace unravel::sim {

/// What a step is expected to cost either way, per particle [ns].
struct IntegratorCosts {
    double substeps = 1;  ///< that `explicit` needs to stay stable; a whole number, as large as it may be
    bool swept = false;  ///< they are fused over the grid
    double explicit_cost = 0;
    double coupled_cost = 0;  ///< adaptive IMEX
    Integrator cheaper() const {
        return explicit_cost <= coupled_cost && substeps <= most_substeps ? Integrator::explicit_ : Integrator::adaptive_imex;
    }
};

/// Counts both from the number of stable substeps (Eq. 7 in the form of sim/step/explicit_limit.hpp), of
/// which the solver's iterations are a multiple, and the costs of sim/step/cost_constants.hpp. It reads no
/// clock and nothing of the state: the same model and step make the same choice in every run, resumed or not.
IntegratorCosts count_costs(const ClothModel& model, const StepOptions& options, double h, StepWorkspace& ws);

/// The options of `integrator = "auto"` with its choice in place of it.
StepOptions choose_integrator(const ClothModel& model, const StepOptions& options, double h,
                              StepWorkspace& ws);

}  // namespace unravel::sim
