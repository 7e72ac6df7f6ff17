#include "sim/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/pins.hpp"

namespace unravel {

namespace {

// Newton's method gives up after this many linearisations; a step that needs more is too large.
constexpr int newton_limit = 30;
// Halvings of a Newton step that would increase the residual.
constexpr int newton_halvings = 4;

// S and z of Eq. (9): pins, then contacts. Depth corrections go into `base`, friction into `friction`.
void constrain(const ClothModel& model, const StepView& view, const ClothState& state, double h,
               StepWorkspace& ws) {
    ws.constraints.reset(model.size());
    constrain_pins(model, view, ws.base, state.t + h, ws.constraints);
    ws.touches.clear();
    if (model.solids.empty()) return;
    pose_solids(model.solids, state.t, h, ws.poses);
    find_touches(model.solids, ws.poses, view, state.contacts, ws.constraints, ws.touches_found, ws.touches);
    constrain_touches(model.solids, view, ws.touches, ws.constraints, ws.base, ws.friction);
}

// Right-hand side of the stage: friction, M (ṽ − v*) and h_f f*, gathered per particle in a fixed order.
void add_forces(const ClothModel& model, StepWorkspace& ws) {
    const Stage& stage = ws.stage;
    ws.impulse.resize(model.size());
    parallel_each(model.size(), [&](std::size_t p) {
        Vec3 f = model.mass[p] * model.gravity;
        const auto gather = [&](const Adjacency& adjacency, const std::vector<Vec3>& force) {
            for (std::uint32_t k = adjacency.start[p]; k < adjacency.start[p + 1]; ++k) {
                const auto [s, other] = adjacency.entries[k];
                f += other > p ? force[s] : Vec3(-force[s]);
            }
        };
        gather(model.spring_adjacency, ws.extension.force);
        gather(model.bend_adjacency, ws.bend);
        ws.impulse[p] = ws.friction[p] + stage.h_force * f + model.mass[p] * (stage.v[p] - stage.v_at[p]);
    });
}

// Forces and Jacobians of the stage at (x*, v*) (Sec. 2) under the scheme's splitting (Sec. 3.5), for a step
// of h seconds.
void linearise(const ClothModel& model, const StepOptions& options, double h, StepWorkspace& ws) {
    const Stage& stage = ws.stage;
    const Splitting splitting = scheme_of(options.integrator).splitting(options.threshold);
    extension_forces(model.springs, model.mass, stage.x_at, stage.v_at, h, splitting, options.activation_band,
                     ws.extension, ws.taut);
    limit_bend(model.bends, model.mass, h, ws.bend_limit);
    ws.bend.resize(model.bends.size());
    bend_forces(model.bends, ws.bend_limit, stage.x_at, ws.bend);
    add_forces(model, ws);
    ws.drift.resize(model.size());
    parallel_each(model.size(),
                  [&](std::size_t p) { ws.drift[p] = ws.base[p] + stage.h * stage.v_at[p] - stage.x_at[p]; });
}

void count_springs(const StepWorkspace& ws, StepReport& report) {
    for (const SpringState s : ws.extension.state) {
        report.implicit += s == SpringState::implicit;
        report.explicit_ += s == SpringState::explicit_;
        report.inactive += s == SpringState::inactive;
    }
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
    assemble(families, load, ws.whole, ws.constraints, ws.stage.h, ws.whole_system);
    solve(ws.whole_system, ws.whole, ws.constraints, guess, options.solve, ws.whole_solve, ws.whole_solves);
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
    ws.solves.clear();
    parallel_each(model.size(), [&](std::size_t p) {
        const Constraint* c = ws.constraints.find(static_cast<std::uint32_t>(p));
        const Vec3 dv = ws.impulse[p] / model.mass[p];
        ws.dv[p] = c ? Vec3(c->S * dv + (c->z - c->S * c->z)) : dv;
    });
}

// The stage's linear system (Eq. 5): decomposed (Sec. 5), assembled, and solved under the constraints (Eq. 9)
// one component at a time. Δv in ws.dv.
void solve_stage(const ClothModel& model, const StepOptions& options, std::span<const Vec3> guess,
                 StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    const std::size_t n = model.size();
    const SpringFamily families[] = {{&model.springs, &model.spring_adjacency, &ws.extension}};
    const Load load{model.mass, ws.impulse, ws.drift};
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
        assemble(families, load, ws.components, ws.constraints, ws.stage.h, ws.system);
        timer.lap(report.times.assembly);
        solve(ws.system, ws.components, ws.constraints, guess, options.solve, ws.solve, ws.solves);
        parallel_each(n, [&](std::size_t row) { ws.dv[ws.components.order[row]] = ws.solve.x[row]; });
        count_solves(ws.solves, report);
        timer.lap(report.times.solve);
    }
    if (options.compare_whole) compare_whole(model, options, families, load, guess, ws, report);
    timer.lap(report.times.compare);
}

// Where the particles will be if the step goes on like the last one, or as solved: x̃ + h̃ (v* + Δv).
void predict(std::span<const Vec3> dv, StepWorkspace& ws) {
    ws.end.resize(dv.size());
    parallel_each(dv.size(),
                  [&](std::size_t p) { ws.end[p] = ws.base[p] + ws.stage.h * (ws.stage.v_at[p] + dv[p]); });
}

// A second solve where the first over-extends springs that were slack: they join in from the start.
void solve_again_where_taut(const ClothModel& model, const StepOptions& options, double h, StageTimer& timer,
                            StepWorkspace& ws, StepReport& report) {
    predict(ws.dv, ws);
    if (!mark_taut(model.springs, ws.end, ws.extension, ws.taut)) return;
    linearise(model, options, h, ws);
    timer.lap(report.times.forces);
    ws.guess = ws.dv;
    solve_stage(model, options, ws.guess, timer, ws, report);
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

// Newton's method (Eq. 4): the stage is linearised again at the end of the step that it gave, until what
// is added no longer matters. The constraints stay as they are; after the first solve they are met, and only
// S remains of them.
void iterate(const ClothModel& model, const StepOptions& options, double h, StageTimer& timer,
             StepWorkspace& ws, StepReport& report) {
    Stage& stage = ws.stage;
    const auto advance = [&](double share) {
        parallel_each(model.size(), [&](std::size_t p) {
            stage.v_at[p] += share * ws.dv[p];
            stage.x_at[p] = ws.base[p] + stage.h * stage.v_at[p];
        });
        ws.taut.clear();
        linearise(model, options, h, ws);
    };
    const double whole = kinetic_of(model.mass, ws.dv), tolerance = options.solve.tolerance;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 1;; ++k) {
        advance(1.0);
        ws.constraints.fulfil();
        double residual = residual_of(model, ws), share = 1.0;
        for (int halving = 0; residual > before && halving < newton_halvings; ++halving) {
            share *= 0.5;
            advance(-share);
            residual = residual_of(model, ws);
        }
        before = residual;
        timer.lap(report.times.forces);
        ws.guess.assign(model.size(), Vec3::Zero());
        solve_stage(model, options, ws.guess, timer, ws, report);
        if (!(kinetic_of(model.mass, ws.dv) > tolerance * tolerance * whole)) return;
        if (k == newton_limit) {
            report.converged = false;
            return;
        }
    }
}

// A Δv − b of every constraint: what holds it.
void find_reactions(const ClothModel& model, StepWorkspace& ws) {
    const std::span<const Constraint> all = ws.constraints.all();
    ws.reaction.resize(all.size());
    parallel_each(all.size(), [&](std::size_t k) {
        const std::uint32_t p = all[k].particle;
        if (!ws.coupled) {
            ws.reaction[k] = model.mass[p] * ws.dv[p] - ws.impulse[p];
            return;
        }
        const std::uint32_t row = ws.system.row_of[p];
        ws.reaction[k] = row_times(ws.system, row, ws.solve.x) - ws.system.b[row];
    });
}

// Contact makes velocities jump: a touching particle looks back on a past in which it has always moved as it
// does now.
void forget_impacts(double h, const StepWorkspace& ws, ClothState& state) {
    for (const Touch& touch : ws.touches) {
        const std::uint32_t p = touch.contact.particle;
        state.v_previous[p] = state.v[p];
        state.x_previous[p] = state.x[p] - h * state.v[p];
    }
}

void require_finite(const StepWorkspace& ws, std::uint64_t step, double h) {
    for (std::uint32_t p = 0; p < ws.dv.size(); ++p) {
        if (ws.dv[p].allFinite()) continue;
        throw SimulationError(
            fmt::format("step {} of {} s: particle {} would get a velocity that is not finite; a smaller "
                        "step or an implicit integrator may hold it",
                        step, h, p),
            step, p);
    }
}

}  // namespace

StepOptions step_options(const Solver& solver) {
    StepOptions options;
    options.integrator = solver.integrator;
    options.threshold = solver.threshold;
    options.activation = solver.activation;
    options.activation_band = solver.activation_band;
    options.solve = {solver.preconditioner, solver.tolerance, solver.max_iterations};
    options.decompose = solver.decompose;
    return options;
}

ClothState initial_state(const Placement& placement) {
    ClothState state;
    state.x = placement.x;
    state.v = placement.v;
    state.dv.assign(placement.x.size(), Vec3::Zero());
    return state;
}

StepReport step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                StepWorkspace& ws) {
    const std::size_t n = model.size();
    StepReport report;
    report.step = state.step + 1;
    report.h = h;
    StageTimer timer;

    // What the scheme takes for known: x̃, ṽ, and where it takes forces (paper Sec. 3)
    const Scheme& scheme = scheme_of(options.integrator);
    Stage& stage = ws.stage;
    scheme.begin(state, h, stage);
    timer.lap(report.times.advance);

    // Constraints (Sec. 4; Baraff & Witkin 1998): S and z
    ws.base = stage.x;
    ws.friction.assign(n, Vec3::Zero());
    const StepView view{state.x, stage.v_at, model.mass, stage.h, model.gravity.norm(), h, stage.h_force};
    constrain(model, view, state, h, ws);
    timer.lap(report.times.contact);

    // Forces at (x*, v*) (Sec. 2) and the adaptive IMEX splitting (Sec. 3.5)
    ws.taut.clear();
    if (options.activation == Activation::predicted) {
        predict(state.dv, ws);
        mark_taut(model.springs, ws.end, {}, ws.taut);
    }
    linearise(model, options, h, ws);
    timer.lap(report.times.forces);

    // Independent components (Sec. 5), A Δv = b (Eq. 5) under Sx = Sb, (I − S)x = (I − S)z (Eq. 9)
    solve_stage(model, options, state.dv, timer, ws, report);
    if (scheme.iterates) {
        iterate(model, options, h, timer, ws, report);
    } else if (options.activation == Activation::resolve) {
        solve_again_where_taut(model, options, h, timer, ws, report);
    }

    require_finite(ws, report.step, h);
    if (!model.solids.empty()) {
        find_reactions(model, ws);
        judge_touches(model.solids, view, ws.constraints, ws.reaction, ws.touches, state.contacts);
    }
    timer.lap(report.times.contact);

    // v' = v* + Δv, x' = x̃ + h̃ v' (Eq. 6), and the contacts' depth corrections that `base` carries
    if (scheme.multistep) {
        state.x_previous.swap(state.x);
        state.v_previous.swap(state.v);
        state.x.resize(n);
        state.v.resize(n);
    }
    parallel_each(n, [&](std::size_t p) {
        const Vec3 v_next = stage.v_at[p] + ws.dv[p];
        state.dv[p] = scheme.iterates ? Vec3(v_next - state.v[p]) : ws.dv[p];
        state.v[p] = v_next;
        state.x[p] = ws.base[p] + stage.h * v_next;
    });
    if (scheme.multistep) forget_impacts(h, ws, state);
    state.h_previous = h;
    ++state.step;
    state.t += h;
    timer.lap(report.times.advance);

    report.t = state.t;
    report.components = static_cast<std::uint32_t>(ws.components.count());
    report.largest = ws.components.largest();
    for (const Constraint& c : ws.constraints.all()) ++(c.free == 0 ? report.constrained : report.partly);
    report.contacts = static_cast<std::uint32_t>(ws.touches.size());
    count_springs(ws, report);
    if (options.measure) measure(model, ws.bend_limit, state, ws.measure, report);
    timer.lap(report.times.measure);
    return report;
}

}  // namespace unravel
