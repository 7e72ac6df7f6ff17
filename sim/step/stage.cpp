#include "sim/step/stage.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace unravel::sim {

namespace {

// Newton's method gives up after this many linearisations; a step that needs more is too large.
constexpr int newton_limit = 30;
// Halvings of a Newton step that would increase the residual.
constexpr int newton_halvings = 4;

// Friction into a system that has none yet.
void begin_friction(const ClothModel& model, StepWorkspace& ws) {
    ws.inertia.clear();
    if (!any_friction(ws.touches)) return;
    ws.inertia = model.mass;
    for (Touch& touch : ws.touches) {
        touch.drag_added = 0;
        touch.push_added.setZero();
    }
    add_friction(ws.stage.v_at, ws.constraints, ws.touches, ws.inertia, ws.impulse);
}

// Right-hand side of the stage: M (ṽ − v*), h_f f* and friction, gathered per particle in a fixed order.
// Forces that were gathered along rows are in `impulse` already.
void add_forces(const ClothModel& model, StepWorkspace& ws) {
    const Stage& stage = ws.stage;
    ws.impulse.resize(model.size());
    parallel_each(model.size(), [&](std::size_t p) {
        Vec3 f = model.mass[p] * model.gravity;
        if (ws.rowwise) f += ws.impulse[p];
        const auto gather = [&](const Adjacency& adjacency, const std::vector<Vec3>& force) {
            adjacency.each(static_cast<std::uint32_t>(p), [&](std::uint32_t s, std::uint32_t other) {
                f += other > p ? force[s] : Vec3(-force[s]);
            });
        };
        if (!ws.rowwise) gather(model.spring_adjacency, ws.extension.force);
        if (ws.bend_is_implicit) {
            gather(ws.bend_adjacency, ws.implicit_bend.forces.force);
        } else if (!ws.rowwise) {
            gather(ws.bend_adjacency, ws.bend);
        }
        if (model.has_temporary_springs()) gather(ws.self.adjacency, ws.self.forces.force);
        ws.impulse[p] = stage.h_force * f + model.mass[p] * (stage.v[p] - stage.v_at[p]);
    });
    if (model.wind && !ws.rowwise) add_air(ws.air_cells, ws.air, stage.h_force, ws.impulse);
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
void compare_whole(const ClothModel& model, const StepOptions& options,
                   std::span<const SpringFamily> families, const Load& load, std::span<const Vec3> guess,
                   StepWorkspace& ws, StepReport& report) {
    report.rvm_whole = report.rvm_whole.value_or(0);
    if (!ws.coupled) return;
    whole_cloth(model.size(), ws.whole);
    const StepSystem system{model.grids,    families, load,       ws.whole,
                            ws.constraints, guess,    ws.stage.h, &model.stitches};
    assemble_components(system, options.solve, ws.whole_grid_solves, ws.whole_system);
    solve_components(system, options.solve, ws.whole_grid_solves, ws.whole_system, ws.whole_solve,
                     ws.whole_solves);
    for (const ComponentSolve& s : ws.whole_solves) *report.rvm_whole += s.rvm;
    for (std::size_t p = 0; p < model.size(); ++p) {
        report.whole_difference = std::max(report.whole_difference, (ws.whole_solve.x[p] - ws.dv[p]).norm());
    }
}

bool any_implicit(std::span<const SpringFamily> families) {
    return std::any_of(families.begin(), families.end(), [](const SpringFamily& family) {
        const std::vector<SpringState>& state = family.forces->state;
        return std::find(state.begin(), state.end(), SpringState::implicit) != state.end();
    });
}

// With no implicit spring A is M: nothing is coupled, nothing assembled, nothing iterated.
void solve_uncoupled(const ClothModel& model, StepWorkspace& ws) {
    lone_particles(model.size(), ws.constraints, ws.components);
    ws.solves.assign(ws.components.count(), {});
    const std::span<const double> inertia = inertia_of(model, ws);
    parallel_each(model.size(), [&](std::size_t p) {
        const Constraint* c = ws.constraints.find(static_cast<std::uint32_t>(p));
        const Vec3 dv = ws.impulse[p] / inertia[p];
        ws.dv[p] = c ? Vec3(c->S * dv + (c->z - c->S * c->z)) : dv;
    });
}

// Where the particles will be if the step goes on like the last one, or as solved: x̃ + h̃ (v* + Δv). Lies
// where linearise() will put the drift.
std::span<const Vec3> predict(std::span<const Vec3> dv, StepWorkspace& ws) {
    ws.drift.resize(dv.size());
    parallel_each(dv.size(),
                  [&](std::size_t p) { ws.drift[p] = ws.base[p] + ws.stage.h * (ws.stage.v_at[p] + dv[p]); });
    return ws.drift;
}

// Where implicit springs are linearised if not at x*: where the scheme says; or, looking ahead, where the
// step would end if nothing but the constraints changed v*.
void place_linearisation(const ClothModel& model, const StepOptions& options, StepWorkspace& ws) {
    ws.ahead = ws.stage.x_linear;
    if (options.activation != Activation::ahead || scheme_of(options.integrator).multistep) return;
    ws.ahead.resize(model.size());
    parallel_each(model.size(), [&](std::size_t p) {
        const Constraint* c = ws.constraints.find(static_cast<std::uint32_t>(p));
        const Vec3 v = c ? Vec3(ws.stage.v_at[p] + c->z - c->S * c->z) : ws.stage.v_at[p];
        ws.ahead[p] = ws.base[p] + ws.stage.h * v;
    });
}

// Sum over particles of |S y|²/m, of the stage's right-hand side y: what Newton's method makes small.
double residual_of(const ClothModel& model, const StepWorkspace& ws) {
    double sum = 0;
    for (std::uint32_t p = 0; p < model.size(); ++p) {
        const Constraint* c = ws.constraints.find(p);
        sum += (c ? Vec3(c->S * ws.impulse[p]) : ws.impulse[p]).squaredNorm() / model.mass[p];
    }
    return sum;
}

// Σ m |y|²
double kinetic_of(std::span<const double> mass, std::span<const Vec3> y) {
    double sum = 0;
    for (std::size_t p = 0; p < y.size(); ++p) sum += mass[p] * y[p].squaredNorm();
    return sum;
}

// J, mechanical, where the step would end if it ended at (x*, v*).
double energy_at_end(const ClothModel& model, StepWorkspace& ws) {
    StepReport end;
    measure(model, ws.bend_limit, ws.stage.x_at, ws.stage.v_at, ws.measure, end);
    return end.kinetic + end.potential;
}

}  // namespace

Families families_of(const ClothModel& model, const StepWorkspace& ws) {
    Families families;
    const auto add = [&](const SpringFamily& family) { families.list[families.count++] = family; };
    const std::span<const Vec3> at = ws.ahead.empty() ? ws.stage.x_at : ws.ahead;
    add({&model.springs, &model.spring_adjacency, &ws.extension, {}, at});
    if (model.has_temporary_springs())
        add({&ws.self.springs, &ws.self.adjacency, &ws.self.forces, ws.drift_from_start});
    if (ws.bend_is_implicit) add({&ws.implicit_bend.springs, &ws.bend_adjacency, &ws.implicit_bend.forces});
    return families;
}

void explicit_forces(const ClothModel& model, const StepOptions& options, double t, double h,
                     StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    const Stage& stage = ws.stage;
    const Scheme& scheme = scheme_of(options.integrator);
    limit_bend(model.bends, model.mass, h, ws.bend_limit);
    ws.bend_is_implicit =
        scheme.implicit_bend && options.bend == BendTreatment::scheme && model.bends.size() > 0;
    const bool at_start =
        stage.x_linear.empty() && (options.activation != Activation::ahead || scheme.multistep);
    ws.rowwise = options.sweep && at_start &&
                 ws.rows.prepare(model, ws.bend_limit,
                                 {h, scheme.splitting(options.threshold), options.activation_band});
    if (ws.rowwise) {
        ws.rows.place(stage.x_at, stage.v_at);
        ws.rows.bend(!ws.bend_is_implicit);
    }
    const bool by_spring = ws.bend_is_implicit || !ws.rowwise;
    if (by_spring && ws.bend_adjacency.start.size() != model.size() + 1)
        ws.bend_adjacency = adjacency_of(model.size(), model.bends.i, model.bends.j);
    if (!ws.rowwise && !ws.bend_is_implicit) {
        ws.bend.resize(model.bends.size());
        bend_forces(model.bends, ws.bend_limit, stage.x_at, ws.bend);
    }
    timer.lap(report.times.forces);
    if (!model.wind) return;
    if (ws.rowwise) {
        ws.rows.blow(model, t);
    } else {
        if (ws.air_cells.start.size() != model.size() + 1) ws.air_cells = air_cells(model);
        ws.air.resize(ws.air_cells.corners.size());
        air_forces(ws.air_cells, *model.wind, t, h, model.mass, stage.x_at, stage.v_at, ws.air);
    }
    timer.lap(report.times.air);
}

void linearise(const ClothModel& model, const StepOptions& options, double h, StageTimer& timer,
               StepWorkspace& ws, StepReport& report) {
    const Stage& stage = ws.stage;
    const Splitting splitting = scheme_of(options.integrator).splitting(options.threshold);
    if (model.has_temporary_springs()) {
        temporary_springs(model, ws.t_end, stage.x_at, stage.v_at, h, splitting.stretch_threshold, ws.self);
        timer.lap(report.times.collision);
    }
    place_linearisation(model, options, ws);
    if (ws.rowwise) {
        ws.impulse.resize(model.size());
        ws.rows.gather(model, ws.taut, ws.impulse, ws.extension.state);
    } else {
        extension_forces(model.springs, model.mass, stage.x_at, stage.v_at, h, splitting,
                         options.activation_band, ws.extension, ws.taut, ws.ahead);
    }
    if (ws.bend_is_implicit)
        bend_jacobians(model.bends, ws.bend_limit, ws.ahead.empty() ? stage.x_at : ws.ahead,
                       ws.implicit_bend);
    add_forces(model, ws);
    const std::span<const Vec3> at = ws.ahead.empty() ? stage.x_at : ws.ahead;
    const auto drift_from = [&](std::span<const Vec3> from, std::vector<Vec3>& drift) {
        drift.resize(model.size());
        parallel_each(model.size(),
                      [&](std::size_t p) { drift[p] = ws.base[p] + stage.h * stage.v_at[p] - from[p]; });
    };
    drift_from(at, ws.drift);
    ws.drift_from_start.clear();
    if (model.has_temporary_springs() && !ws.ahead.empty()) drift_from(stage.x_at, ws.drift_from_start);
    timer.lap(report.times.forces);
}

void solve_stage(const ClothModel& model, const StepOptions& options, std::span<const Vec3> guess,
                 StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    const std::size_t n = model.size();
    const Families all = families_of(model, ws);
    const std::span<const SpringFamily> families = all;
    const Load load{inertia_of(model, ws), ws.impulse, ws.drift};
    ws.dv.resize(n);
    ws.coupled = any_implicit(families);
    if (!ws.coupled) {
        solve_uncoupled(model, ws);
        timer.lap(report.times.solve);
    } else {
        if (options.decompose) {
            find_components(n, families, ws.constraints, ws.parent, ws.components);
        } else {
            whole_cloth(n, ws.components);
        }
        timer.lap(report.times.graph);
        const StepSystem system{model.grids,    families, load,       ws.components,
                                ws.constraints, guess,    ws.stage.h, &model.stitches};
        assemble_components(system, options.solve, ws.grid_solves, ws.system);
        timer.lap(report.times.assembly);
        solve_components(system, options.solve, ws.grid_solves, ws.system, ws.solve, ws.solves);
        parallel_each(n, [&](std::size_t row) { ws.dv[ws.components.order[row]] = ws.solve.x[row]; });
        count_solves(ws.solves, report);
        timer.lap(report.times.solve);
    }
    if (!options.compare_whole) return;
    compare_whole(model, options, families, load, guess, ws, report);
    timer.lap(report.times.compare);
}

void predict_taut(const ClothModel& model, std::span<const Vec3> dv, StepWorkspace& ws) {
    const std::span<const Vec3> end = predict(dv, ws);
    if (ws.rowwise) {
        ws.rows.mark(model, end, ws.taut);
    } else {
        mark_taut(model.springs, end, {}, ws.taut);
    }
}

void solve_again_where_taut(const ClothModel& model, const StepOptions& options, double h, StageTimer& timer,
                            StepWorkspace& ws, StepReport& report) {
    if (!mark_taut(model.springs, predict(ws.dv, ws), ws.extension, ws.taut)) return;
    linearise(model, options, h, timer, ws, report);
    ws.guess = ws.dv;
    solve_stage(model, options, ws.guess, timer, ws, report);
}

void iterate(const ClothModel& model, const StepOptions& options, double h, StageTimer& timer,
             StepWorkspace& ws, StepReport& report) {
    Stage& stage = ws.stage;
    stage.x_linear.clear();
    stage.own_at();
    const auto advance = [&](double share) {
        parallel_each(model.size(), [&](std::size_t p) {
            stage.own.v_at[p] += share * ws.dv[p];
            stage.own.x_at[p] = ws.base[p] + stage.h * stage.v_at[p];
        });
        if (ws.rowwise) ws.rows.place(stage.x_at, stage.v_at);
        ws.taut.clear();
        linearise(model, options, h, timer, ws, report);
    };
    const double whole = kinetic_of(model.mass, ws.dv), tolerance = options.solve.tolerance;
    // What is at rest moves by rounding alone, of which no share is small.
    const double still = position_rounding(stage.x_at) / stage.h;
    const double rounding =
        still * still * std::accumulate(model.mass.begin(), model.mass.end(), 0.0);
    if (whole <= rounding) return;
    double before = std::numeric_limits<double>::infinity();
    ws.constraints.fulfil();
    for (int k = 1;; ++k) {
        advance(1.0);
        if (options.energy_limit && energy_at_end(model, ws) <= *options.energy_limit) {
            ws.dv.assign(model.size(), Vec3::Zero());
            return;
        }
        double residual = residual_of(model, ws), share = 1.0;
        for (int halving = 0; residual > before && halving < newton_halvings; ++halving) {
            share *= 0.5;
            advance(-share);
            residual = residual_of(model, ws);
        }
        before = residual;
        ws.guess.assign(model.size(), Vec3::Zero());
        solve_stage(model, options, ws.guess, timer, ws, report);
        if (!(kinetic_of(model.mass, ws.dv) > std::max(tolerance * tolerance * whole, rounding))) return;
        if (k == newton_limit) {
            report.converged = false;
            return;
        }
    }
}

}  // namespace unravel::sim
