#include "sim/step/stage.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <ranges>

namespace unravel::sim {

namespace {

// Newton's method gives up after this many linearisations; a step that needs more is too large.
constexpr int newton_limit = 30;
// Strain that a spring may come to in the step in which it goes taut before it is made to act in that step:
// what it pulls too late is then a hundredth of what it can bear at most, and most steps have none such.
constexpr double missed_strain = 0.01;
// Solves after the first for what was misjudged: springs that act make others act.
constexpr int most_solves_again = 4;
// Halvings of a Newton step that would increase the residual.
constexpr int newton_halvings = 4;

// Friction into a system that has none yet.
void begin_friction(const ClothModel& model, StepWorkspace& ws) {
    ContactStage& contact = ws.contact;
    contact.inertia.clear();
    if (!any_friction(contact.touches)) return;
    contact.inertia = model.mass;
    for (Touch& touch : contact.touches) {
        touch.drag_added = 0;
        touch.push_added.setZero();
    }
    add_friction(ws.stage.v_at, ws.constraints, contact.touches, contact.inertia, ws.linear.impulse);
}

// Forces at (x*, v*), and the right-hand side of the stage: M (ṽ − v*), h_f f* and friction. Gathered per
// particle in the order of the terms.
void add_forces(const ClothModel& model, StepWorkspace& ws) {
    ForceStage& forces = ws.forces;
    const ForcePlan& plan = ws.plan.forces;
    forces.sum.resize(model.size());
    if (plan.by_rows) {
        forces.rows.gather(model, forces.taut, forces.sum, forces.memory.springs.state);
        if (!forces.pushes.empty())
            parallel_each(model.size(), [&](std::size_t p) { forces.sum[p] += forces.pushes[p]; });
    } else if (!forces.pushes.empty()) {
        forces.sum = forces.pushes;
    } else {
        forces.sum.assign(model.size(), Vec3::Zero());
    }
    for (const ForcePlan::Term& planned : plan.terms) {
        const bool added = planned.stiffens || !planned.by_rows;
        if (planned.term->add && added) planned.term->add(model, forces.memory, forces.sum);
    }
    const Stage& stage = ws.stage;
    const bool surfaces = !ws.contact.surfaces.stencils.empty();
    const auto pushed = [&](std::size_t p) {
        return surfaces ? contact_force(ws.contact.surfaces, static_cast<std::uint32_t>(p))
                        : Vec3(Vec3::Zero());
    };
    ws.linear.impulse.resize(model.size());
    parallel_each(model.size(), [&](std::size_t p) {
        ws.linear.impulse[p] =
            stage.h_force * (forces.sum[p] + pushed(p)) + model.mass[p] * (stage.v[p] - stage.v_at[p]);
    });
    begin_friction(model, ws);
}

void count_solves(const std::vector<ComponentSolve>& solves, StepReport& report) {
    for (const ComponentSolve& s : solves) {
        report.cg_iterations += s.iterations;
        report.cg_iterations_max = std::max(report.cg_iterations_max, s.iterations);
        report.rvm += s.rvm;
        report.converged = report.converged && s.converged;
    }
}

// The oracle: the very same system, undecomposed.
void compare_whole(const ClothModel& model, const StepOptions& options, const StepCouplings& couplings,
                   const Load& load, std::span<const Vec3> guess, StepWorkspace& ws, StepReport& report) {
    report.rvm_whole = report.rvm_whole.value_or(0);
    if (!ws.linear.coupled) return;
    WholeStage& whole = ws.whole;
    whole_cloth(model.size(), whole.components);
    const StepSystem system{model.grids,    couplings, load,       whole.components,
                            ws.constraints, guess,     ws.stage.h, &model.stitches};
    assemble_components(system, options.solve, whole.grids, whole.system);
    solve_components(system, options.solve, whole.grids, whole.system, whole.solve, whole.solves);
    for (const ComponentSolve& s : whole.solves) *report.rvm_whole += s.rvm;
    for (std::size_t p = 0; p < model.size(); ++p) {
        report.whole_difference =
            std::max(report.whole_difference, (whole.solve.x[p] - ws.linear.dv[p]).norm());
    }
}

// With nothing implicit A is M: nothing is coupled, nothing assembled, nothing iterated.
void solve_uncoupled(const ClothModel& model, StepWorkspace& ws) {
    LinearStage& linear = ws.linear;
    lone_particles(model.size(), ws.constraints, linear.components);
    const std::span<const double> inertia = inertia_of(model, ws);
    linear.solves.assign(linear.components.count(), {});
    parallel_each(model.size(), [&](std::size_t p) {
        const Constraint* c = ws.constraints.find(static_cast<std::uint32_t>(p));
        const Vec3 dv = linear.impulse[p] / inertia[p];
        linear.dv[p] = c ? Vec3(c->S * dv + (c->z - c->S * c->z)) : dv;
    });
}

// Where the particles will be if the step goes on like the last one, or as solved: x̃ + h̃ (v* + Δv).
std::span<const Vec3> predict(std::span<const Vec3> dv, StepWorkspace& ws) {
    const std::span<const Vec3> base = ws.base();
    ws.linear.predicted.resize(dv.size());
    parallel_each(dv.size(), [&](std::size_t p) {
        ws.linear.predicted[p] = base[p] + ws.stage.h * (ws.stage.v_at[p] + dv[p]);
    });
    return ws.linear.predicted;
}

// Where implicit springs are linearised if not at x*: where the scheme says; or, looking ahead, where the
// step would end if nothing but the constraints changed v*.
void place_linearisation(const ClothModel& model, const StepOptions& options, StepWorkspace& ws) {
    std::vector<Vec3>& ahead = ws.forces.ahead;
    ahead = ws.stage.x_linear;
    if (options.activation != Activation::ahead || scheme_of(options.integrator).multistep) return;
    const std::span<const Vec3> base = ws.base();
    ahead.resize(model.size());
    parallel_each(model.size(), [&](std::size_t p) {
        const Constraint* c = ws.constraints.find(static_cast<std::uint32_t>(p));
        const Vec3 v = c ? Vec3(ws.stage.v_at[p] + c->z - c->S * c->z) : ws.stage.v_at[p];
        ahead[p] = base[p] + ws.stage.h * v;
    });
}

// Where the step would end if nothing but gravity and the constraints changed v*.
std::span<const Vec3> foresee(const ClothModel& model, StepWorkspace& ws) {
    const Stage& stage = ws.stage;
    const std::span<const Vec3> base = ws.base();
    std::vector<Vec3>& foreseen = ws.contact.foreseen;
    foreseen.resize(model.size());
    parallel_each(model.size(), [&](std::size_t p) {
        const Constraint* c = ws.constraints.find(static_cast<std::uint32_t>(p));
        const Vec3 fall = stage.h_force * model.gravity;
        const Vec3 dv = c ? Vec3(c->S * (fall - c->z) + c->z) : fall;
        foreseen[p] = base[p] + stage.h * (stage.v_at[p] + dv);
    });
    return foreseen;
}

// Contact of cloth with cloth and of edges and faces with solids, between surfaces, at (x*, v*).
void find_surface_contacts(const ClothModel& model, StepWorkspace& ws) {
    const Stage& stage = ws.stage;
    const ForceSettings& settings = ws.plan.forces.settings;
    const double threshold = settings.splitting.stretch_threshold;
    SurfaceContactWorkspace& surfaces = ws.contact.surfaces;
    const std::span<const Vec3> foreseen = foresee(model, ws);
    begin_contacts(surfaces);
    if (model.cloth_by_surfaces())
        find_contacts(model, stage.x_at, stage.v_at, foreseen, settings.h, threshold, surfaces);
    if (model.solids_by_surfaces())
        find_solid_contacts(model, ws.contact.poses, stage.x_at, stage.v_at, foreseen, settings.h, threshold,
                            surfaces);
    end_contacts(model.size(), surfaces);
}

// Sum over particles of |S y|²/m, of the stage's right-hand side y: what Newton's method makes small.
double residual_of(const ClothModel& model, const StepWorkspace& ws) {
    double sum = 0;
    for (std::uint32_t p = 0; p < model.size(); ++p) {
        const Constraint* c = ws.constraints.find(p);
        const Vec3& y = ws.linear.impulse[p];
        sum += (c ? Vec3(c->S * y) : y).squaredNorm() / model.mass[p];
    }
    return sum;
}

// Σ m |y|²
double kinetic_of(std::span<const double> mass, std::span<const Vec3> y) {
    double sum = 0;
    for (std::size_t p = 0; p < y.size(); ++p) sum += mass[p] * y[p].squaredNorm();
    return sum;
}

// J that the step to `end` (particles) loses, ½ m |Δv|² of backward Euler, beyond what its explicit springs
// add for the moment; but for a small share, which is not worth another solve.
double energy_to_spare(const ClothModel& model, std::span<const Vec3> end, StepWorkspace& ws) {
    constexpr double small = 0.05;
    const double lost = 0.5 * kinetic_of(model.mass, ws.linear.dv);
    const StepEnds ends{ws.plan.forces.settings, ws.forces.t, ws.stage.x_at, ws.stage.v_at, end, {}};
    double gain = 0;
    for (const ForcePlan::Term& planned : ws.plan.forces.terms) {
        if (planned.term->explicit_gain)
            gain += planned.term->explicit_gain(model, ends, ws.forces.memory, ws.measure);
    }
    return std::max(lost - gain, small * lost);
}

// J, mechanical, where the step would end if it ended at (x*, v*).
double energy_at_end(const ClothModel& model, StepWorkspace& ws) {
    StepReport end;
    measure(model, ws.forces.memory, ws.stage.x_at, ws.stage.v_at, ws.measure, end);
    return end.kinetic + end.potential;
}

}  // namespace

ForcesAt forces_at(const StepWorkspace& ws) {
    return {ws.plan.forces.settings, ws.forces.t,     ws.forces.t_end, ws.stage.x_at,
            ws.stage.v_at,           ws.forces.ahead, ws.forces.taut,  ws.linear.drift_from_start};
}

StepCouplings couplings_of(const ClothModel& model, const StepWorkspace& ws) {
    StepCouplings couplings;
    const ForcesAt at = forces_at(ws);
    for (const ForcePlan::Term& planned : ws.plan.forces.terms) {
        if (planned.implicit || planned.stiffens)
            planned.term->couple(model, at, ws.forces.memory, couplings);
    }
    const SurfaceContactWorkspace& surfaces = ws.contact.surfaces;
    if (!surfaces.stencils.empty())
        couplings.stencils.push_back({surfaces.stencils, surfaces.state, at.drift_from_start});
    return couplings;
}

void begin_forces(const ClothModel& model, const StepOptions& options, double t, double h, StageTimer& timer,
                  StepWorkspace& ws, StepReport& report) {
    ForceStage& forces = ws.forces;
    const bool looks_ahead = !ws.stage.x_linear.empty() || (options.activation == Activation::ahead &&
                                                            !scheme_of(options.integrator).multistep);
    const PlanMemory::Key key = plan_key(model, options, h, looks_ahead);
    if (ws.plan.forces_key != key) {
        ws.plan.forces = plan_forces(model, options, h, looks_ahead);
        ws.plan.forces_key = key;
    }
    const ForcePlan& plan = ws.plan.forces;
    prepare_terms(model, h, forces.memory);
    forces.t = t;
    forces.t_end = t + h;
    forces.taut.clear();
    forces.ahead.clear();
    forces.pushes.clear();
    if (plan.by_rows) {
        forces.rows.prepare(model, forces.memory, plan.settings);
        forces.rows.place(ws.stage.x_at, ws.stage.v_at);
        forces.rows.begin();
    }
    const ForcesAt at = forces_at(ws);
    for (const ForcePlan::Term& planned : plan.terms) {
        const ForceTerm& term = *planned.term;
        if (planned.implicit) continue;
        if (planned.by_rows) {
            if (term.rows) forces.rows.push(model, *term.rows, t);
        } else if (term.push) {
            if (forces.pushes.empty()) forces.pushes.assign(model.size(), Vec3::Zero());
            term.push(model, at, forces.memory, forces.pushes);
        } else {
            term.evaluate(model, at, forces.memory);
        }
        if (planned.stiffens) term.stiffen(model, at, forces.memory);
        timer.lap(report.times.*term.time);
    }
}

void linearise(const ClothModel& model, const StepOptions& options, StageTimer& timer, StepWorkspace& ws,
               StepReport& report) {
    const Stage& stage = ws.stage;
    LinearStage& linear = ws.linear;
    if (model.by_surfaces()) {
        find_surface_contacts(model, ws);
        timer.lap(report.times.collision);
    }
    place_linearisation(model, options, ws);
    timer.lap(report.times.forces);
    for (const ForcePlan::Term& planned : ws.plan.forces.terms) {
        if (!planned.stiffens && (!planned.implicit || planned.by_rows)) continue;
        planned.term->evaluate(model, forces_at(ws), ws.forces.memory);
        timer.lap(report.times.*planned.term->time);
    }
    add_forces(model, ws);
    const std::span<const Vec3> base = ws.base();
    const auto drift_from = [&](std::span<const Vec3> from, std::vector<Vec3>& drift) {
        drift.resize(model.size());
        parallel_each(model.size(),
                      [&](std::size_t p) { drift[p] = base[p] + stage.h * stage.v_at[p] - from[p]; });
    };
    drift_from(forces_at(ws).linearised_at(), linear.drift);
    linear.drift_from_start.clear();
    const auto implicit = [](const ForcePlan::Term& planned) { return planned.implicit; };
    if (!ws.forces.ahead.empty() &&
        (!ws.contact.surfaces.stencils.empty() || std::ranges::count_if(ws.plan.forces.terms, implicit) > 1))
        drift_from(stage.x_at, linear.drift_from_start);
    timer.lap(report.times.forces);
}

void solve_stage(const ClothModel& model, const StepOptions& options, std::span<const Vec3> guess,
                 StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    const std::size_t n = model.size();
    const StepCouplings couplings = couplings_of(model, ws);
    LinearStage& linear = ws.linear;
    const Load load{inertia_of(model, ws), linear.impulse, linear.drift};
    linear.dv.resize(n);
    linear.coupled = any_implicit(couplings);
    if (!linear.coupled) {
        solve_uncoupled(model, ws);
        timer.lap(report.times.solve);
    } else {
        if (options.decompose) {
            find_components(n, couplings, ws.constraints, linear.parent, linear.components);
        } else {
            whole_cloth(n, linear.components);
        }
        timer.lap(report.times.graph);
        const StepSystem system{model.grids,    couplings, load,       linear.components,
                                ws.constraints, guess,     ws.stage.h, &model.stitches};
        assemble_components(system, options.solve, linear.grids, linear.system);
        timer.lap(report.times.assembly);
        solve_components(system, options.solve, linear.grids, linear.system, linear.solve, linear.solves);
        parallel_each(
            n, [&](std::size_t row) { linear.dv[linear.components.order[row]] = linear.solve.x[row]; });
        count_solves(linear.solves, report);
        timer.lap(report.times.solve);
    }
    if (!options.compare_whole) return;
    compare_whole(model, options, couplings, load, guess, ws, report);
    timer.lap(report.times.compare);
}

void predict_taut(const ClothModel& model, std::span<const Vec3> dv, StepWorkspace& ws) {
    const std::span<const Vec3> end = predict(dv, ws);
    if (ws.plan.forces.by_rows) {
        ws.forces.rows.mark(model, end, ws.forces.taut);
    } else {
        mark_taut(model.springs, end, ws.forces.taut);
    }
}

void solve_again_where_taut(const ClothModel& model, const StepOptions& options, StageTimer& timer,
                            StepWorkspace& ws, StepReport& report) {
    const bool once = options.activation == Activation::resolve;
    const ForceSettings& settings = ws.plan.forces.settings;
    for (int k = 0; k < (once ? 1 : most_solves_again); ++k) {
        const std::span<const Vec3> end = predict(ws.linear.dv, ws);
        const Misjudged misjudged =
            correct_taut(model.springs, model.mass, settings.h, settings.splitting, ws.stage.x_at, end,
                         ws.forces.memory.springs, once ? 0.0 : missed_strain, ws.forces.taut);
        if (!misjudged.missed && (once || misjudged.energy <= energy_to_spare(model, end, ws))) return;
        linearise(model, options, timer, ws, report);
        ws.linear.guess = ws.linear.dv;
        solve_stage(model, options, ws.linear.guess, timer, ws, report);
    }
}

void iterate(const ClothModel& model, const StepOptions& options, StageTimer& timer, StepWorkspace& ws,
             StepReport& report) {
    Stage& stage = ws.stage;
    LinearStage& linear = ws.linear;
    stage.x_linear.clear();
    stage.own_at();
    const auto advance = [&](double share) {
        parallel_each(model.size(), [&](std::size_t p) {
            stage.own.v_at[p] += share * linear.dv[p];
            stage.own.x_at[p] = ws.base()[p] + stage.h * stage.v_at[p];
        });
        if (ws.plan.forces.by_rows) ws.forces.rows.place(stage.x_at, stage.v_at);
        ws.forces.taut.clear();
        linearise(model, options, timer, ws, report);
    };
    const double whole = kinetic_of(model.mass, linear.dv), tolerance = options.solve.tolerance;
    // What is at rest moves by rounding alone, of which no share is small.
    const double still = position_rounding(stage.x_at) / stage.h;
    const double rounding = still * still * std::accumulate(model.mass.begin(), model.mass.end(), 0.0);
    if (whole <= rounding) return;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 1;; ++k) {
        advance(1.0);
        ws.constraints.clear_prescribed();
        if (options.energy_limit && energy_at_end(model, ws) <= *options.energy_limit) {
            linear.dv.assign(model.size(), Vec3::Zero());
            return;
        }
        double residual = residual_of(model, ws), share = 1.0;
        for (int halving = 0; residual > before && halving < newton_halvings; ++halving) {
            share *= 0.5;
            advance(-share);
            residual = residual_of(model, ws);
        }
        before = residual;
        linear.guess.assign(model.size(), Vec3::Zero());
        solve_stage(model, options, linear.guess, timer, ws, report);
        if (!(kinetic_of(model.mass, linear.dv) > std::max(tolerance * tolerance * whole, rounding))) return;
        if (k == newton_limit) {
            report.converged = false;
            return;
        }
    }
}

}  // namespace unravel::sim
