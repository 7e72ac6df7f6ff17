#include "sim/step/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/constraints/pins.hpp"
#include "sim/step/choose_integrator.hpp"
#include "sim/step/stage.hpp"

namespace unravel::sim {

namespace {

// S and z of Eq. (9): pins, then contacts. Depth corrections go into `base`.
void constrain(const ClothModel& model, const StepView& view, const ClothState& state, double h,
               StepWorkspace& ws) {
    ws.constraints.reset(model.size());
    constrain_pins(model, view, ws.base, state.t + h, ws.constraints);
    ws.touches.clear();
    ws.inertia.clear();
    if (model.solids.empty()) return;
    ws.corrected.assign(ws.base.begin(), ws.base.end());
    ws.base = ws.corrected;
    pose_solids(model.solids, state.t, h, ws.poses);
    find_touches(model.solids, ws.poses, view, state.contacts, ws.constraints, ws.touches_found, ws.touches);
    settle_depths(view, ws.touches, ws.corrected);
    try_holds(model.solids, view, ws.touches);
    constrain_touches(view, ws.touches, ws.stage.x, ws.constraints);
}

void count_springs(std::span<const SpringFamily> families, StepReport& report) {
    for (const SpringFamily& family : families) {
        for (const SpringState s : family.forces->state) {
            report.implicit += s == SpringState::implicit;
            report.explicit_ += s == SpringState::explicit_;
            report.inactive += s == SpringState::inactive;
        }
    }
}

// What friction cannot hold slides, and the step is solved again (sim/constraints/friction.hpp).
void settle_friction(const ClothModel& model, const StepOptions& options, const StepView& view, double t_end,
                     StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    for (ws.trials = 0; ws.trials < most_trials; ++ws.trials) {
        find_reactions(model, ws);
        if (!test_holds(model.solids, view, ws.constraints, ws.reaction, ws.v_constrained, ws.touches)) return;
        ws.constraints.reset(model.size());
        constrain_pins(model, view, ws.stage.x, t_end, ws.constraints);
        constrain_touches(view, ws.touches, ws.stage.x, ws.constraints);
        if (ws.inertia.empty()) ws.inertia = model.mass;
        add_friction(ws.stage.v_at, ws.constraints, ws.touches, ws.inertia, ws.impulse);
        timer.lap(report.times.contact);
        ws.guess = ws.dv;
        solve_stage(model, options, ws.guess, timer, ws, report);
    }
}

// What a multistep scheme looks back on. Contact makes velocities jump: a touching particle looks back on a
// past in which it has always moved as it does now.
void remember(double h, const ClothState& state, const StepWorkspace& ws, ClothState& next) {
    next.x_previous = state.x;
    next.v_previous = state.v;
    for (const Touch& touch : ws.touches) {
        const std::uint32_t p = touch.contact.particle;
        next.v_previous[p] = next.v[p];
        next.x_previous[p] = next.x[p] - h * next.v[p];
    }
}

}  // namespace

void find_reactions(const ClothModel& model, StepWorkspace& ws) {
    const std::span<const Constraint> all = ws.constraints.all();
    ws.reaction.resize(all.size());
    ws.v_constrained.resize(all.size());
    parallel_each(all.size(), [&](std::size_t k) {
        const std::uint32_t p = all[k].particle;
        ws.v_constrained[k] = ws.stage.v_at[p] + ws.dv[p];
        if (!ws.coupled) {
            ws.reaction[k] = inertia_of(model, ws)[p] * ws.dv[p] - ws.impulse[p];
            return;
        }
        const std::uint32_t row = ws.system.row_of[p];
        ws.reaction[k] = row_times(ws.system, row, ws.solve.x) - ws.system.b[row];
    });
}

StepOptions step_options(const Solver& solver) {
    StepOptions options;
    options.integrator = solver.integrator;
    options.threshold = solver.threshold;
    options.bend = solver.bend;
    options.activation = solver.activation;
    options.activation_band = solver.activation_band;
    options.substeps = solver.substeps;
    options.solve = {solver.preconditioner, solver.tolerance, solver.max_iterations};
    options.decompose = solver.decompose;
    return options;
}

void require_finite(std::span<const Vec3> v, const ClothState& state, double h) {
    for (std::uint32_t p = 0; p < v.size(); ++p) {
        if (v[p].allFinite()) continue;
        StepFailure failure;
        failure.step = state.step + 1;
        failure.t = state.t;
        failure.h = h;
        failure.particles = {p};
        failure.value = v[p].norm();
        failure.limit = std::numeric_limits<double>::max();
        failure.advice = fmt::format("take a smaller step than {} s, or an implicit integrator", h);
        throw SimulationError(
            fmt::format("step {} (from {:.6g} s, {:.6g} s long): particle {} would get a velocity that is "
                        "not finite; {}",
                        failure.step, failure.t, h, p, failure.advice),
            failure);
    }
}

void begin_next(const ClothState& state, double h, ClothState& next) {
    const std::size_t n = state.x.size();
    next.step = state.step + 1;
    next.t = state.t + h;
    next.h_previous = h;
    next.halvings = state.halvings;
    next.whole_steps = state.whole_steps;
    next.part = state.part;
    next.strain = state.strain;
    next.contacts.clear();
    for (std::vector<Vec3>* y : {&next.x, &next.v, &next.dv}) y->resize(n);
    next.x_previous.clear();
    next.v_previous.clear();
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
    if (options.integrator == Integrator::automatic)
        return step(model, choose_integrator(model, options, h, ws), h, state, ws);
    // `explicit` has no system, so that its steps can be many, short, and fused.
    if (options.integrator == Integrator::explicit_) return explicit_step(model, options, h, state, ws);
    return coupled_step(model, options, h, state, ws);
}

StepReport coupled_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                        StepWorkspace& ws) {
    const std::size_t n = model.size();
    StepReport report;
    report.step = state.step + 1;
    report.h = h;
    ws.swept = false;
    StageTimer timer;

    // What the scheme takes for known: x̃, ṽ, and where it takes forces (paper Sec. 3)
    const Scheme& scheme = scheme_of(options.integrator);
    Stage& stage = ws.stage;
    scheme.begin(state, h, stage);
    ws.base = stage.x;
    timer.lap(report.times.advance);

    // Constraints (Sec. 4; Baraff & Witkin 1998): S and z
    const bool constrained = !model.pins.empty() || !model.solids.empty();
    const StepView view{state.x, stage.v_at, model.mass, stage.h, model.gravity, h, stage.h_force};
    constrain(model, view, state, h, ws);
    if (constrained) timer.lap(report.times.contact);

    ws.t_end = state.t + h;
    // Forces at (x*, v*) (Sec. 2) and the adaptive IMEX splitting (Sec. 3.5)
    ws.taut.clear();
    explicit_forces(model, options, state.t, h, timer, ws, report);
    // Multistep schemes look ahead by themselves: at x*.
    if (options.activation == Activation::predicted && !scheme.multistep) predict_taut(model, state.dv, ws);
    linearise(model, options, h, timer, ws, report);

    // Independent components (Sec. 5), A Δv = b (Eq. 5) under Sx = Sb, (I − S)x = (I − S)z (Eq. 9)
    solve_stage(model, options, state.dv, timer, ws, report);
    if (!model.solids.empty()) settle_friction(model, options, view, state.t + h, timer, ws, report);
    const bool iterates = scheme.iterates || options.energy_limit;
    if (iterates) {
        iterate(model, options, h, timer, ws, report);
    } else if (options.activation == Activation::resolve) {
        solve_again_where_taut(model, options, h, timer, ws, report);
    }

    require_finite(ws.dv, state, h);
    ClothState& next = ws.before;
    begin_next(state, h, next);
    if (!model.solids.empty()) {
        find_reactions(model, ws);
        judge_touches(model.solids, view, ws.constraints, ws.reaction, ws.v_constrained, ws.touches,
                      next.contacts);
        timer.lap(report.times.contact);
    }

    // v' = v* + Δv, x' = x̃ + h̃ v' (Eq. 6), and the contacts' depth corrections that `base` carries
    parallel_each(n, [&](std::size_t p) {
        next.v[p] = stage.v_at[p] + ws.dv[p];
        next.dv[p] = iterates ? Vec3(next.v[p] - state.v[p]) : ws.dv[p];
        next.x[p] = ws.base[p] + stage.h * next.v[p];
    });
    if (!model.solids.empty()) keep_outside(model.solids, ws.poses, ws.constraints, h, next.x, next.v);
    if (scheme.multistep) remember(h, state, ws, next);
    std::swap(state, next);
    timer.lap(report.times.advance);

    report.t = state.t;
    report.components = static_cast<std::uint32_t>(ws.components.count());
    report.largest = ws.components.largest();
    for (const Constraint& c : ws.constraints.all()) ++(c.free == 0 ? report.constrained : report.partly);
    report.contacts = static_cast<std::uint32_t>(ws.touches.size());
    count_springs(families_of(model, ws), report);
    report.self_contacts =
        static_cast<std::uint32_t>(model.self_collision ? ws.self.springs.size() - model.stitches.size() : 0);
    report.self_distance = ws.self.least_distance;
    if (options.measure) measure(model, ws.bend_limit, state, ws.measure, report);
    timer.lap(report.times.measure);
    return report;
}

}  // namespace unravel::sim
