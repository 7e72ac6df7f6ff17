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

// S and z of Eq. (9): pins, then contacts, with their depth corrections.
void constrain(const ClothModel& model, const StepView& view, const ClothState& state, double h,
               StepWorkspace& ws) {
    ContactStage& contact = ws.contact;
    ws.constraints.reset(model.size());
    constrain_pins(model, view, ws.stage.x, state.t + h, ws.constraints);
    contact.touches.clear();
    if (model.solids.empty()) return;
    contact.corrected.assign(ws.stage.x.begin(), ws.stage.x.end());
    pose_solids(model.solids, state.t, h, contact.poses);
    find_touches(model.solids, contact.poses, view, state.contacts, ws.constraints, contact.found,
                 contact.touches);
    settle_touches(model.solids, view, contact.touches, contact.corrected);
    try_holds(model.solids, view, contact.touches);
    constrain_touches(model.solids, view, contact.touches, ws.stage.x, ws.constraints);
}

void count_springs(const StepCouplings& couplings, StepReport& report) {
    for (const SpringFamily& family : couplings.springs) {
        for (const SpringState s : family.forces->state) {
            report.implicit += s == SpringState::implicit;
            report.explicit_ += s == SpringState::explicit_;
            report.inactive += s == SpringState::inactive;
        }
    }
}

// What friction is far from holding slides, and the step is solved again (sim/constraints/friction.hpp).
void settle_friction(const ClothModel& model, const StepOptions& options, const StepView& view, double t_end,
                     StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    ContactStage& contact = ws.contact;
    for (contact.trials = 0; contact.trials < most_trials; ++contact.trials) {
        find_reactions(model, ws);
        if (!test_holds(model.solids, view, ws.constraints, contact.reactions, contact.touches)) break;
        ws.constraints.reset(model.size());
        constrain_pins(model, view, ws.stage.x, t_end, ws.constraints);
        constrain_touches(model.solids, view, contact.touches, ws.stage.x, ws.constraints);
        if (contact.inertia.empty()) contact.inertia = model.mass;
        add_friction(ws.stage.v_at, ws.constraints, contact.touches, contact.inertia, ws.linear.impulse);
        timer.lap(report.times.contact);
        ws.linear.guess = ws.linear.dv;
        solve_stage(model, options, ws.linear.guess, timer, ws, report);
    }
    timer.lap(report.times.contact);
}

// What a multistep scheme looks back on. Contact makes velocities jump: a touching particle looks back on a
// past in which it has always moved as it does now.
void remember(double h, const ClothState& state, const StepWorkspace& ws, ClothState& next) {
    next.x_previous = state.x;
    next.v_previous = state.v;
    for (const Touch& touch : ws.contact.touches) {
        const std::uint32_t p = touch.contact.particle;
        next.v_previous[p] = next.v[p];
        next.x_previous[p] = next.x[p] - h * next.v[p];
    }
}

}  // namespace

void find_reactions(const ClothModel& model, StepWorkspace& ws) {
    const std::span<const Constraint> all = ws.constraints.all();
    const LinearStage& linear = ws.linear;
    Reactions& out = ws.contact.reactions;
    out.resize(all.size());
    parallel_each(all.size(), [&](std::size_t k) {
        const std::uint32_t p = all[k].particle;
        out.velocity[k] = ws.stage.v_at[p] + linear.dv[p];
        if (!linear.coupled) {
            const double inertia = inertia_of(model, ws)[p];
            out.impulse[k] = inertia * linear.dv[p] - linear.impulse[p];
            out.block[k] = inertia * Mat3::Identity();
            return;
        }
        const std::uint32_t row = linear.system.row_of[p];
        out.impulse[k] = row_times(linear.system, row, linear.solve.x) - linear.system.b[row];
        out.block[k] = linear.system.diagonal[row];
    });
}

namespace {

// Contacts that pulled strongly in the last step and, though let go, do in this one.
std::uint32_t count_pulling(const ClothModel& model, std::span<const Contact> last,
                            std::span<const Contact> now) {
    constexpr double strongly = 10;  // times the particle's weight
    const auto pulls = [&](const Contact& c) {
        return c.force < -strongly * model.mass[c.particle] * model.gravity.norm();
    };
    std::uint32_t count = 0;
    auto other = last.begin();
    for (const Contact& c : now) {
        const auto place = [](const Contact& k) { return std::pair(k.particle, k.solid); };
        while (other != last.end() && place(*other) < place(c)) ++other;
        count += other != last.end() && place(*other) == place(c) && pulls(c) && pulls(*other);
    }
    return count;
}

// No surface passes through another on the way to the step's end; what is stopped moves accordingly.
void stop_impacts(const ClothModel& model, double h, const ClothState& state, StepWorkspace& ws,
                  StageTimer& timer, ClothState& next, StepReport& report) {
    timer.lap(report.times.advance);
    const std::vector<Vec3> free = next.x;
    std::vector<std::uint8_t>& fixed = ws.contact.apart.fixed;
    fixed.assign(model.size(), 0);
    for (const Constraint& c : ws.constraints.all()) fixed[c.particle] = 1;
    for (const Touch& touch : ws.contact.touches) fixed[touch.contact.particle] = 0;
    const Apart apart =
        keep_apart(model, state.x, ws.constraints, fixed, next.x, ws.contact.surfaces, ws.contact.apart);
    if (!apart.kept) {
        StepFailure failure;
        failure.criterion = Criterion::pinched;
        failure.step = state.step + 1;
        failure.t = state.t;
        failure.h = h;
        failure.particles.assign(apart.particles.begin(), apart.particles.end());
        failure.advice = "let the pins or solids leave the layers room between them";
        std::swap(next, ws.before);
        throw SimulationError(
            fmt::format("step {} (from {:.6g} s, {:.6g} s long): what holds particle {} drives its cloth "
                        "through other cloth; {}",
                        failure.step, failure.t, h, apart.particles[0], failure.advice),
            failure);
    }
    parallel_each(next.x.size(), [&](std::size_t p) {
        const Vec3 change = (next.x[p] - free[p]) / ws.stage.h;
        if (change.isZero(0)) return;
        next.v[p] += change;
        next.dv[p] += change;
    });
    timer.lap(report.times.collision);
}

}  // namespace

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
    heed(options.solve.stop);
    const StepPlan& plan = plan_step(model, options, h, ws);
    StepOptions planned = options;
    planned.integrator = plan.integrator;
    // Explicit steps have no system, so that they can be many, short, and fused.
    switch (plan.way) {
        case StepPlan::Way::swept:
            return swept_step(model, planned, h, plan.substeps, state, ws);
        case StepPlan::Way::in_turn:
            return substeps_in_turn(model, planned, h, plan.substeps, state, ws);
        case StepPlan::Way::coupled:
            break;
    }
    // A multistep scheme looks back on a step as long as its own.
    if (model.solids_by_surfaces() && !scheme_of(planned.integrator).multistep)
        return uncut_step(model, planned, h, state, ws);
    return coupled_step(model, planned, h, state, ws);
}

StepReport coupled_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
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
    const bool constrained = !model.pins.empty() || !model.solids.empty();
    const StepView view{state.x, stage.v_at, model.mass, stage.h, model.gravity, h, stage.h_force};
    constrain(model, view, state, h, ws);
    if (constrained) timer.lap(report.times.contact);

    // Forces at (x*, v*) (Sec. 2) and the adaptive IMEX splitting (Sec. 3.5)
    begin_forces(model, options, state.t, h, timer, ws, report);
    // Multistep schemes look ahead by themselves: at x*.
    if (options.activation == Activation::predicted && !scheme.multistep) predict_taut(model, state.dv, ws);
    linearise(model, options, timer, ws, report);

    // Independent components (Sec. 5), A Δv = b (Eq. 5) under Sx = Sb, (I − S)x = (I − S)z (Eq. 9)
    solve_stage(model, options, state.dv, timer, ws, report);
    if (!model.solids.empty()) settle_friction(model, options, view, state.t + h, timer, ws, report);
    const bool iterates = scheme.iterates || options.energy_limit;
    if (iterates) {
        iterate(model, options, timer, ws, report);
    } else if (options.activation == Activation::resolve || options.activation == Activation::predicted) {
        solve_again_where_taut(model, options, timer, ws, report);
    }
    require_finite(ws.linear.dv, state, h);

    // From here on the state is the next one; all that was read of it is now the one before.
    std::swap(state, ws.before);
    const ClothState& before = ws.before;
    begin_next(before, h, state);
    if (!model.solids.empty()) {
        find_reactions(model, ws);
        judge_touches(model.solids, view, ws.constraints, ws.contact.reactions, ws.contact.touches,
                      state.contacts);
        report.pulling = count_pulling(model, before.contacts, state.contacts);
        timer.lap(report.times.contact);
    }

    // v' = v* + Δv, x' = x̃ + h̃ v' (Eq. 6), and the contacts' depth corrections
    const std::span<const Vec3> base = ws.base();
    parallel_each(n, [&](std::size_t p) {
        state.v[p] = stage.v_at[p] + ws.linear.dv[p];
        state.dv[p] = iterates ? Vec3(state.v[p] - before.v[p]) : ws.linear.dv[p];
        state.x[p] = base[p] + stage.h * state.v[p];
    });
    if (!model.solids.empty())
        keep_outside(model.solids, ws.contact.poses, ws.constraints, h, state.x, state.v);
    if (model.solids_by_surfaces()) {
        keep_edges_outside(model, ws.contact.poses, ws.constraints, h, ws.contact.surfaces, state.x, state.v);
    }
    if (model.cloth_by_surfaces()) stop_impacts(model, h, before, ws, timer, state, report);
    if (scheme.multistep) remember(h, before, ws, state);
    timer.lap(report.times.advance);

    report.t = state.t;
    report.contacts = static_cast<std::uint32_t>(ws.contact.touches.size());
    count_springs(couplings_of(model, ws), report);
    for (const ForcePlan::Term& planned : ws.plan.forces.terms) {
        if (planned.term->count) planned.term->count(ws.forces.memory, report);
    }
    if (model.cloth_by_surfaces()) {
        report.self_contacts = static_cast<std::uint32_t>(ws.contact.surfaces.stencils.size());
        report.self_distance = ws.contact.surfaces.least_distance;
    }
    finish_report(model, options, state, timer, ws, report);
    return report;
}

void finish_report(const ClothModel& model, const StepOptions& options, const ClothState& state,
                   StageTimer& timer, StepWorkspace& ws, StepReport& report) {
    report.components = static_cast<std::uint32_t>(ws.linear.components.count());
    report.largest = ws.linear.components.largest();
    for (const Constraint& c : ws.constraints.all()) ++(c.free == 0 ? report.constrained : report.partly);
    if (options.measure) measure(model, ws.forces.memory, state, ws.measure, report);
    timer.lap(report.times.measure);
}

}  // namespace unravel::sim
