#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/integrators/scheme.hpp"
#include "sim/linear/solve.hpp"
#include "sim/terms/terms.hpp"

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

/// How the options' scheme splits springs and bending.
Splitting splitting_of(const StepOptions& options);

/// Which code evaluates the forces of a coupled step, decided once for a model, a size of step and its
/// options.
struct ForcePlan {
    ForceSettings settings;
    bool by_rows = false;  ///< forces that have a version along rows are evaluated so, on all cloths
    std::string because;   ///< why, or why not
    struct Term {
        const ForceTerm* term;
        bool by_rows;   ///< evaluated along rows; otherwise the general path
        bool implicit;  ///< its springs may be: they are evaluated with every linearisation
        bool stiffens;  ///< it pushes, and in places answers within the step (ForceTerm::stiffen)
        std::string because;
    };
    std::vector<Term> terms;  ///< those that act
};

/// What steps of a run go through, and why: decided when the first is taken and again when the model, the
/// size of the step or an option has changed. It reads no clock and nothing of the state.
struct StepPlan {
    enum class Way {
        coupled,  ///< all particles together, by a linear system where springs are implicit
        swept,    ///< explicit substeps fused along the rows of grids (sim/sweep/explicit_sweep.hpp)
        in_turn   ///< explicit substeps one after the other, each like a coupled step
    };
    Integrator integrator = Integrator::adaptive_imex;  ///< `auto` has been decided
    std::string integrator_because;
    Way way = Way::coupled;
    std::string way_because;
    int substeps = 1;  ///< of an explicit step
    ForcePlan forces;  ///< of each substep that is not swept
    struct Cloth {
        std::string name;
        bool by_rows;  ///< its forces, in whole
        std::string forces_because;
        std::string solver;  ///< what solves its components
        std::string solver_because;
    };
    std::vector<Cloth> cloths;
};

const char* way_name(StepPlan::Way way);

/// Plans the forces of coupled steps of h seconds. `looks_ahead`: implicit springs are linearised elsewhere
/// than at x*, which rows don't.
ForcePlan plan_forces(const ClothModel& model, const StepOptions& options, double h, bool looks_ahead);

/// Plans and decisions, kept while what they depend on stays.
struct PlanMemory {
    /// All that plans depend on.
    struct Key {
        const double* model = nullptr;  ///< its masses
        std::size_t particles = 0;
        double h = 0;
        Integrator integrator{};
        double threshold = 0, band = 0;
        BendTreatment bend{};
        Activation activation{};
        Preconditioner preconditioner{};
        double tolerance = 0;
        int substeps = 0;
        bool sweep = true, looks_ahead = false;
        std::vector<const ForceTerm*> further_terms;  ///< the model's
        friend bool operator==(const Key&, const Key&) = default;
    };
    std::optional<Key> step_key, forces_key;
    StepPlan step;
    ForcePlan forces;        ///< of the last coupled step
    double stable_step = 0;  ///< s, the largest of `explicit`; 0: not asked for yet
};

/// Substeps that a step of h seconds of `explicit` is divided into: as many as the options say, or as bring
/// each below its limit of stability (sim/step/explicit_limit.hpp) by a margin. A whole number, as large as
/// it may be.
double substeps_of(const ClothModel& model, const StepOptions& options, double h, PlanMemory& memory);

PlanMemory::Key plan_key(const ClothModel& model, const StepOptions& options, double h, bool looks_ahead);

}  // namespace unravel::sim
