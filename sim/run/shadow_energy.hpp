#pragma once

#include "sim/model/model.hpp"
#include "sim/model/report.hpp"
#include "sim/model/state.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

/// What forward-backward Euler keeps is not the energy H but a shadow of it, since v' lags half a step behind
/// x' (backward error analysis: Hairer, Lubich & Wanner 2006, IX.3; f = -grad V, K its Hessian):
///   H + h/2 v·f + h²/12 (v·K v + f·f/m) + O(h³);
/// for linear springs the first of these terms is enough. H swings by them for ever, and does not grow.
struct ShadowTerms {
    double first = 0, second = 0;  ///< J, the terms in h and h²
};

/// Of steps of h seconds in this state. `forces`: as prepare_terms() left it. Pinned particles do no work.
ShadowTerms shadow_terms(const ClothModel& model, ForceMemory& forces, const ClothState& state, double h);

/// The energy that a run moves [J]: what it starts with, and its weight lifted by the cloth's size. By this
/// its least may differ from its start. `start`: energies of the state before the first step.
double energy_scale(const ClothModel& model, const ClothState& state, const StepReport& start);

}  // namespace unravel::sim
