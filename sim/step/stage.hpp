#pragma once

#include <span>
#include <vector>

#include "sim/step/step.hpp"

namespace unravel::sim {

/// The linear algebra of one stage (sim/integrators/scheme.hpp): forces at (x*, v*), the system for Δv, and
/// what some schemes do beyond one solve. All work on the step's workspace.

/// Where the stage takes forces.
ForcesAt forces_at(const StepWorkspace& ws);

/// What may be implicit, of every term that has any.
StepCouplings couplings_of(const ClothModel& model, const StepWorkspace& ws);

/// Plans the forces of the step of h seconds from t and evaluates those that are explicit whatever the
/// splitting, at (x*, v*).
void begin_forces(const ClothModel& model, const StepOptions& options, double t, double h, StageTimer& timer,
                  StepWorkspace& ws, StepReport& report);

/// Forces and Jacobians of the springs at (x*, v*) (Sec. 2) under the scheme's splitting (Sec. 3.5), and the
/// stage's right-hand side.
void linearise(const ClothModel& model, const StepOptions& options, StageTimer& timer, StepWorkspace& ws,
               StepReport& report);

/// The stage's linear system (Eq. 5): decomposed (Sec. 5), assembled, and solved under the constraints (Eq.
/// 9) one component at a time, from `guess` (particles) [m/s]. Δv in the linear stage.
void solve_stage(const ClothModel& model, const StepOptions& options, std::span<const Vec3> guess,
                 StageTimer& timer, StepWorkspace& ws, StepReport& report);

/// Before the first solve: marks springs that would be taut if the step went on like the last one, of which
/// `dv` (particles) is Δv [m/s].
void predict_taut(const ClothModel& model, std::span<const Vec3> dv, StepWorkspace& ws);

/// Solves again where the first solve over-extends springs that were slack, by what may not be missed, or
/// where they and slack ones that were expected to be taut, and push, have put in more energy than the step
/// loses: those act from the start, these don't.
void solve_again_where_taut(const ClothModel& model, const StepOptions& options, StageTimer& timer,
                            StepWorkspace& ws, StepReport& report);

/// Newton's method (Eq. 4): the stage is linearised again at the end of the step that it gave, until what is
/// added no longer matters. The constraints stay as they are; after the first solve they are met, and only S
/// remains of them. Always-explicit forces stay those of the start.
void iterate(const ClothModel& model, const StepOptions& options, StageTimer& timer, StepWorkspace& ws,
             StepReport& report);

/// What stands in front of Δv besides what couples particles (particles) [kg]: mass, and what resists
/// sliding.
inline std::span<const double> inertia_of(const ClothModel& model, const StepWorkspace& ws) {
    return ws.contact.inertia.empty() ? std::span<const double>(model.mass) : ws.contact.inertia;
}

/// What the last solve has given each constraint: the contact stage's reactions.
void find_reactions(const ClothModel& model, StepWorkspace& ws);

/// What a step of h seconds from `state` makes, but for what it computes: x, v, dv and contacts.
void begin_next(const ClothState& state, double h, ClothState& next);

/// Throws SimulationError where a velocity or a change of it, `v` (particles), that a step of h seconds from
/// `state` made is not finite.
void require_finite(std::span<const Vec3> v, const ClothState& state, double h);

/// step() by any scheme that treats all particles together.
StepReport coupled_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                        StepWorkspace& ws);

/// step() of `explicit`, divided into substeps that are swept over grids (sim/sweep/), or taken one after the
/// other.
StepReport swept_step(const ClothModel& model, const StepOptions& options, double h, int substeps,
                      ClothState& state, StepWorkspace& ws);
StepReport substeps_in_turn(const ClothModel& model, const StepOptions& options, double h, int substeps,
                            ClothState& state, StepWorkspace& ws);

/// coupled_step(), taken again in parts, as long as need be, where it would end with cloth in or behind a
/// solid that holds off its surface: what is thin, or pulled at hard, is met before it is passed.
StepReport uncut_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                      StepWorkspace& ws);

/// Makes one step of h seconds of parts that were taken one after the other from `start`: the report is the
/// last one's, with all their times.
void join_parts(const ClothState& start, double h, std::uint32_t parts, const StageTimes& times,
                ClothState& state, StepReport& report);

/// What every kind of step ends with: components and constraints counted, the state measured.
void finish_report(const ClothModel& model, const StepOptions& options, const ClothState& state,
                   StageTimer& timer, StepWorkspace& ws, StepReport& report);

}  // namespace unravel::sim
