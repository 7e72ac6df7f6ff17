#pragma once

#include <vector>

#include "sim/constraints/contact.hpp"
#include "sim/constraints/friction.hpp"
#include "sim/linear/components.hpp"
#include "sim/linear/solve.hpp"
#include "sim/linear/system.hpp"
#include "sim/model/state.hpp"
#include "sim/self_collision/keep_apart.hpp"
#include "sim/self_collision/solid_contact.hpp"
#include "sim/step/plan.hpp"
#include "sim/step/solve_components.hpp"
#include "sim/sweep/explicit_sweep.hpp"
#include "sim/sweep/row_forces.hpp"
#include "sim/terms/measure.hpp"

namespace unravel::sim {

/// What a step computes on the way, stage by stage, kept between steps for its memory. Each member means one
/// thing from the stage that fills it to the end of the step; others than the step look at it through
/// sim/step/trace.hpp.

/// Contact; empty where a scene has neither solids nor self-collision.
struct ContactStage {
    SolidPoses poses;
    std::vector<std::vector<Touch>> found;  ///< (chunks of particles)
    std::vector<Touch> touches;
    std::vector<Vec3> corrected;  ///< (particles) x̃ with the contacts' depth corrections [m]
    std::vector<double> inertia;  ///< (particles) kg, mass and what resists sliding; empty where none slides
    Reactions reactions;
    std::uint32_t trials = 0;  ///< times that the step was solved again for friction
    /// Between surfaces: of cloth with cloth, and of edges and faces with solids.
    SurfaceContactWorkspace surfaces;
    std::vector<Vec3> foreseen;  ///< (particles) where the step would end without it [m]
    KeepApartWorkspace apart;
};

/// Forces at (x*, v*), and where they are linearised.
struct ForceStage {
    ForceMemory memory;
    RowForces rows;            ///< where the plan takes forces along rows
    std::vector<Vec3> pushes;  ///< (particles) explicit forces that came not along rows [N]; empty: none
    std::vector<Vec3> sum;     ///< (particles) all forces [N]
    std::vector<std::uint8_t> taut;  ///< (springs) 1: slack at x*, taut at the end; or empty
    std::vector<Vec3> ahead;         ///< (particles) where implicit springs are linearised [m]; empty: at x*
    double t = 0, t_end = 0;         ///< s, of the step
};

/// The linear system of Eq. (5) and its solution.
struct LinearStage {
    std::vector<Vec3> impulse;  ///< (particles) right-hand side without the springs' h K g [kg·m/s]
    std::vector<Vec3> drift;    ///< (particles) g, how far each moves without the solve [m]
    std::vector<Vec3>
        drift_from_start;         ///< (particles) the same for springs that don't look ahead [m]; or empty
    std::vector<Vec3> predicted;  ///< (particles) where the step would end [m]
    std::vector<Vec3> guess;      ///< (particles) where a second solve starts [m/s]
    bool coupled = false;         ///< some spring is implicit, so that there is a system
    std::vector<std::uint32_t> parent;  ///< scratch of the search for components
    Components components;
    System system;
    SolveWorkspace solve;
    GridSolves grids;
    std::vector<ComponentSolve> solves;  ///< (components)
    std::vector<Vec3> dv;                ///< (particles) Δv [m/s]
};

/// The very same system undecomposed, where a step is to be compared with it.
struct WholeStage {
    Components components;
    System system;
    SolveWorkspace solve;
    GridSolves grids;
    std::vector<ComponentSolve> solves;
};

struct StepWorkspace {
    PlanMemory plan;
    Stage stage;  ///< what the scheme takes for known (sim/integrators/scheme.hpp)
    Constraints constraints;
    ContactStage contact;
    ForceStage forces;
    LinearStage linear;
    WholeStage whole;
    ExplicitSweep sweep;
    ClothState before;  ///< the state from which the last step started
    MeasureWorkspace measure;

    /// x̃ with the contacts' depth corrections [m].
    std::span<const Vec3> base() const { return contact.corrected.empty() ? stage.x : contact.corrected; }
};

}  // namespace unravel::sim
