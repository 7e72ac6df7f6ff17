#include "sim/step/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/step/choose_integrator.hpp"
#include "sim/step/explicit_limit.hpp"
#include "sim/step/step.hpp"

namespace unravel::sim {

namespace {

std::string why_general(const ClothModel& model, const StepOptions& options, bool looks_ahead) {
    if (!options.sweep) return "the general path was asked for";
    if (looks_ahead) return "springs are linearised elsewhere than forces are taken";
    return why_not_by_rows(model);
}

void plan_integrator(const ClothModel& model, const StepOptions& options, double h, PlanMemory& memory,
                     StepPlan& plan) {
    plan.integrator = options.integrator;
    plan.integrator_because = "solver.integrator names it";
    StepOptions asked = options;
    if (options.integrator == Integrator::automatic) {
        const IntegratorCosts costs = count_costs(model, options, h, memory);
        plan.integrator = costs.cheaper();
        plan.integrator_because = fmt::format(
            "explicit would need {:.6g} substeps, about {:.2g} us per particle and step against {:.2g}",
            costs.substeps, 1e-3 * costs.explicit_cost, 1e-3 * costs.coupled_cost);
        asked.substeps = 0;
    }
    if (plan.integrator != Integrator::explicit_) {
        plan.way = StepPlan::Way::coupled;
        plan.way_because = "implicit springs couple particles";
        return;
    }
    // Who starts a run has refused what is more than most_substeps.
    plan.substeps = static_cast<int>(std::min(substeps_of(model, asked, h, memory), 1e9));
    const std::string why_not = options.sweep ? why_not_swept(model) : "the general path was asked for";
    plan.way = why_not.empty() ? StepPlan::Way::swept : StepPlan::Way::in_turn;
    plan.way_because =
        why_not.empty() ? "every cloth is a grid, and all that acts on it has a version along rows" : why_not;
}

bool bends_over_two_cells(const GridSprings& grid) {
    return grid.bend_u.count() + grid.bend_v.count() > 0 && !arcs_between_neighbours(grid);
}

void plan_cloths(const ClothModel& model, const StepOptions& options, StepPlan& plan) {
    const bool explicit_step = plan.way != StepPlan::Way::coupled, swept = plan.way == StepPlan::Way::swept;
    const auto general = std::ranges::find(plan.forces.terms, false, &ForcePlan::Term::by_rows);
    const bool by_rows = swept || general == plan.forces.terms.end();
    const std::string because = swept ? plan.way_because
                                : by_rows || !plan.forces.by_rows
                                    ? plan.forces.because
                                    : fmt::format("{} {}", general->term->name, general->because);
    const bool bends = std::ranges::any_of(plan.forces.terms, [](const ForcePlan::Term& planned) {
        return planned.implicit && planned.term == &bending_term;
    });
    auto grid = model.grids.begin();  // one of each cloth that is a grid
    for (const ClothPatch& patch : model.cloths) {
        const bool bends_beyond = patch.grid() && bends && bends_over_two_cells(*grid++);
        StepPlan::Cloth& cloth = plan.cloths.emplace_back();
        cloth.name = patch.name;
        cloth.by_rows = by_rows;
        cloth.forces_because = because;
        if (explicit_step) {
            cloth.solver = "none";
            cloth.solver_because = "nothing is implicit";
        } else if (bends_beyond) {
            cloth.solver = "rows in double precision";
            cloth.solver_because =
                "bending is implicit and by arcs over two cells, which no grid's solver has";
        } else if (!patch.grid() || !may_use_grids(options.solve)) {
            cloth.solver = "rows in double precision";
            cloth.solver_because = patch.grid() ? "solver.preconditioner or solver.tolerance asks for it"
                                                : "the cloth is a mesh";
        } else {
            cloth.solver = fmt::format(
                "the grid in single precision for components of {} particles or more, rows in double for "
                "others",
                least_rows_on_grid);
            cloth.solver_because = "the cloth is a grid";
        }
    }
}

}  // namespace

StepOptions step_options(const Solver& solver) {
    StepOptions options;
    options.integrator = solver.integrator;
    options.threshold = solver.threshold;
    options.bend = solver.bend;
    options.activation = solver.activation;
    options.activation_band = solver.activation_band;
    options.substeps = solver.substeps;
    options.solve = {solver.preconditioner, solver.tolerance, solver.max_iterations, nullptr};
    options.decompose = solver.decompose;
    return options;
}

Splitting splitting_of(const StepOptions& options) {
    Splitting splitting = scheme_of(options.integrator).splitting(options.threshold);
    if (options.bend == BendTreatment::explicit_) splitting.bend_threshold = always_explicit;
    return splitting;
}

const char* way_name(StepPlan::Way way) {
    switch (way) {
        case StepPlan::Way::swept:
            return "explicit, swept";
        case StepPlan::Way::in_turn:
            return "explicit, in turn";
        case StepPlan::Way::coupled:
            break;
    }
    return "coupled";
}

double substeps_of(const ClothModel& model, const StepOptions& options, double h, PlanMemory& memory) {
    if (options.substeps > 0) return options.substeps;
    if (memory.stable_step == 0) {
        StepOptions whole = options;
        whole.substeps = 1;
        memory.stable_step = explicit_limit(model, whole, h).step;
    }
    return stable_substeps(h, memory.stable_step);
}

PlanMemory::Key plan_key(const ClothModel& model, const StepOptions& options, double h, bool looks_ahead) {
    PlanMemory::Key key;
    key.model = model.mass.data();
    key.particles = model.size();
    key.h = h;
    key.integrator = options.integrator;
    key.threshold = options.threshold;
    key.band = options.activation_band;
    key.bend = options.bend;
    key.activation = options.activation;
    key.preconditioner = options.solve.preconditioner;
    key.tolerance = options.solve.tolerance;
    key.substeps = options.substeps;
    key.sweep = options.sweep;
    key.looks_ahead = looks_ahead;
    key.further_terms = model.further_terms;
    return key;
}

ForcePlan plan_forces(const ClothModel& model, const StepOptions& options, double h, bool looks_ahead) {
    ForcePlan plan;
    plan.settings = {h, splitting_of(options), options.activation_band, false};
    const Splitting& splitting = plan.settings.splitting;
    plan.settings.all_explicit =
        splitting.stretch_threshold >= always_explicit && splitting.shear_threshold >= always_explicit;
    plan.because = why_general(model, options, looks_ahead);
    plan.by_rows = plan.because.empty();
    if (plan.by_rows) plan.because = "every cloth is a grid";
    each_term(model, [&](const ForceTerm& term) {
        const bool implicit = term.may_be_implicit && term.may_be_implicit(model, plan.settings);
        const bool has_rows = term.part_of_rows || (term.rows && (!implicit || term.rows->splits));
        const bool stiffens = term.stiffen && !plan.settings.all_explicit;
        plan.terms.push_back({&term, plan.by_rows && has_rows, implicit, stiffens,
                              !plan.by_rows ? plan.because
                              : has_rows    ? "has a version along rows"
                              : term.rows   ? "is implicit, which it is not along rows"
                                            : "has no version along rows"});
    });
    return plan;
}

const StepPlan& plan_step(const ClothModel& model, const StepOptions& options, double h, StepWorkspace& ws) {
    PlanMemory& memory = ws.plan;
    const PlanMemory::Key key = plan_key(model, options, h, false);
    if (memory.step_key == key) return memory.step;
    StepPlan plan;
    plan_integrator(model, options, h, memory, plan);
    StepOptions taken = options;
    taken.integrator = plan.integrator;
    // A multistep scheme starts with a step that linearises springs where it takes forces; all others don't.
    plan.forces =
        plan_forces(model, taken, h / plan.substeps,
                    scheme_of(plan.integrator).multistep || options.activation == Activation::ahead);
    plan_cloths(model, options, plan);
    memory.step = std::move(plan);
    memory.step_key = key;
    return memory.step;
}

}  // namespace unravel::sim
