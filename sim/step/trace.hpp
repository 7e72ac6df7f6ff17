#pragma once

#include "sim/step/step.hpp"

namespace unravel::sim {

/// What a step computed on the way, for those who look into it. Valid until the next step.
struct StepTrace {
    const StepPlan& plan;
    const ClothState& before;  ///< what it started from
    double h;                  ///< s, h̃ of its stage
    bool coupled;              ///< there was a linear system
    ForcesAt forces_at;        ///< where springs were evaluated
    const ForceMemory& forces;
    const Constraints& constraints;
    const Components& components;
    const std::vector<ComponentSolve>& solves;  ///< (components)
    std::span<const SpringState> springs;       ///< (stretch and shear springs)
    std::span<const Vec3> dv;                   ///< (particles) Δv of the solve [m/s]
    Load load;                                  ///< what the system was made of, with
    StepCouplings couplings;                    ///< what couples particles in it
    const System& system;                       ///< of the components that no grid solved
    const GridSolves& grids;
};

/// Of the step that was taken last in this workspace.
StepTrace trace_of(const ClothModel& model, const StepWorkspace& ws);

/// Force of each stretch and shear spring on its lower end where the step took it [N]: rows keep none.
std::vector<Vec3> spring_forces(const ClothModel& model, const StepTrace& trace);

}  // namespace unravel::sim
