#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/constraints/contact.hpp"
#include "sim/constraints/friction.hpp"
#include "sim/integrators/scheme.hpp"
#include "sim/linear/components.hpp"
#include "sim/linear/solve.hpp"
#include "sim/linear/system.hpp"
#include "sim/model/failure.hpp"
#include "sim/model/model.hpp"
#include "sim/model/report.hpp"
#include "sim/model/state.hpp"
#include "sim/self_collision/self_collision.hpp"
#include "sim/step/measure.hpp"
#include "sim/step/solve_components.hpp"
#include "sim/sweep/explicit_sweep.hpp"
#include "sim/sweep/row_forces.hpp"

namespace unravel::sim {

struct StepOptions {
    Integrator integrator = Integrator::adaptive_imex;
    double threshold = 0.2;  ///< of adaptive IMEX on κ (7)
    BendTreatment bend = BendTreatment::scheme;
    Activation activation = Activation::predicted;  ///< when a slack spring becomes implicit
    double activation_band = 0.0;                   ///< see extension_forces()
    SolveOptions solve;
    int substeps = 1;       ///< of `explicit`; 0: as many as its limit of stability asks for
    bool sweep = true;      ///< false: forces on grids are evaluated like all others (the oracle)
    bool decompose = true;  ///< false: the whole cloth as one system
    /// J: linearise again, whatever the scheme, until the step's end is met or holds no more energy than
    /// this.
    std::optional<double> energy_limit;
    bool compare_whole = false;  ///< solve the undecomposed system too and report what it took
    bool measure = true;         ///< fill the report's strain, lowest point and energies
};

StepOptions step_options(const Solver& solver);

/// Everything that a step computes on the way; read by inspectors, kept only for its memory.
struct StepWorkspace {
    Stage stage;
    Constraints constraints;
    SolidPoses poses;
    std::vector<std::vector<Touch>> touches_found;  ///< (chunks of particles)
    std::vector<Touch> touches;
    RowForces rows;        ///< where every cloth is a grid
    bool rowwise = false;  ///< forces are gathered by it; of `extension` there is only the state
    ExtensionForces extension;
    BendLimit bend_limit;
    std::vector<Vec3> bend;      ///< (bend springs) N; empty where they are implicit
    ImplicitBend implicit_bend;  ///< empty where they are explicit
    Adjacency bend_adjacency;    ///< empty where forces are gathered along rows
    bool bend_is_implicit = false;
    AirCells air_cells;                  ///< empty without wind, and where forces are gathered along rows
    std::vector<Vec3> air;               ///< (cells) N; empty as they are
    double t_end = 0;                    ///< s, the end of the step: what stitches are to have reached
    SelfCollisionWorkspace self;         ///< empty without self-collision and stitches
    std::vector<std::uint8_t> taut;      ///< (springs) 1: slack at x*, taut at the end; or empty
    std::vector<Vec3> ahead;             ///< (particles) where implicit springs are linearised; empty: at x*
    std::vector<Vec3> drift_from_start;  ///< (particles) drift for those that are linearised at x* even so
    std::span<const Vec3> base;  ///< (particles) x̃ with the contacts' depth corrections; during a step
    std::vector<Vec3> corrected;              ///< (particles) empty without solids
    std::vector<double> inertia;              ///< (particles) kg, mass and friction; empty where none slides
    std::vector<Vec3> impulse, drift, guess;  ///< (particles)
    std::uint32_t trials = 0;                 ///< of friction, that failed in the last step
    std::vector<Vec3> reaction;               ///< (constraints) kg·m/s
    std::vector<Vec3> v_constrained;          ///< (constraints) at the step's end [m/s]
    bool coupled = false;                     ///< some spring is implicit, so that there is a system
    std::vector<std::uint32_t> parent;
    Components components, whole;
    System system, whole_system;
    SolveWorkspace solve, whole_solve;
    GridSolves grid_solves, whole_grid_solves;
    std::vector<ComponentSolve> solves, whole_solves;  ///< (components)
    std::vector<Vec3> dv;                              ///< (particles) m/s
    ExplicitSweep sweep;
    bool swept = false;  ///< the last step was made by it
    Integrator chosen = Integrator::automatic;  ///< what `auto` takes for steps of `chosen_for` seconds
    double chosen_for = 0;
    double explicit_step = 0;  ///< s, the largest stable step of `explicit`; 0: not asked for yet
    /// The state that the step makes; once made it is the other's, and this is the state before the step.
    ClothState before;
    MeasureWorkspace measure;
};

/// Starts a state from where the scene places the cloth.
ClothState initial_state(const Placement& placement);

/// Substeps that a step of h seconds of `explicit` is divided into: as many as the options say, or as bring
/// each below its limit of stability (sim/step/explicit_limit.hpp) by a margin. A whole number, as large as it
/// may be.
double substeps_of(const ClothModel& model, const StepOptions& options, double h, StepWorkspace& ws);

/// Advances the state by h seconds; ws.before is then what it was. Throws SimulationError where a velocity
/// would not be finite; the state is then what it was before.
StepReport step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                StepWorkspace& ws);

}  // namespace unravel::sim
