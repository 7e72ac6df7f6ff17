#include "sim/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/pins.hpp"

namespace unravel {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// S and z of Eq. (9): pins, then contacts. Depth corrections go into `base`, friction into `impulse`.
void constrain(const ClothModel& model, const StepView& view, const ClothState& state, double h,
               StepWorkspace& ws) {
    ws.constraints.reset(model.size());
    constrain_pins(model, view, ws.base, state.t + h, ws.constraints);
    ws.touches.clear();
    if (model.solids.empty()) return;
    pose_solids(model.solids, state.t, h, ws.poses);
    find_touches(model.solids, ws.poses, view, state.contacts, ws.constraints, ws.touches_found, ws.touches);
    constrain_touches(model.solids, view, ws.touches, ws.constraints, ws.base, ws.impulse);
}

// h f: gravity, springs and bend springs, gathered per particle in a fixed order, on top of what friction
// left there.
void add_forces(const ClothModel& model, double h, StepWorkspace& ws) {
    parallel_each(model.size(), [&](std::size_t p) {
        Vec3 f = model.mass[p] * model.gravity;
        const auto gather = [&](const Adjacency& adjacency, const std::vector<Vec3>& force) {
            for (std::uint32_t k = adjacency.start[p]; k < adjacency.start[p + 1]; ++k) {
                const auto [s, other] = adjacency.entries[k];
                f += other > p ? force[s] : Vec3(-force[s]);
            }
        };
        gather(model.spring_adjacency, ws.extension.force);
        if (model.self_collision) gather(ws.self.adjacency, ws.self.forces.force);
        gather(model.bend_adjacency, ws.bend);
        ws.impulse[p] += h * f;
    });
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
                   std::span<const SpringFamily> families, const Load& load, double h,
                   const ClothState& state, StepWorkspace& ws, StepReport& report) {
    whole_cloth(model.size(), ws.whole);
    assemble(families, load, ws.whole, ws.constraints, h, ws.whole_system);
    solve(ws.whole_system, ws.whole, ws.constraints, state.dv, options.solve, ws.whole_solve,
          ws.whole_solves);
    report.rvm_whole = 0;
    for (const ComponentSolve& s : ws.whole_solves) *report.rvm_whole += s.rvm;
    for (std::size_t p = 0; p < model.size(); ++p) {
        report.whole_difference = std::max(report.whole_difference, (ws.whole_solve.x[p] - ws.dv[p]).norm());
    }
}

// A Δv − b of every constraint: what holds it.
void find_reactions(StepWorkspace& ws) {
    const std::span<const Constraint> all = ws.constraints.all();
    ws.reaction.resize(all.size());
    parallel_each(all.size(), [&](std::size_t k) {
        const std::uint32_t row = ws.system.row_of[all[k].particle];
        ws.reaction[k] = row_times(ws.system, row, ws.solve.x) - ws.system.b[row];
    });
}

void require_finite(const StepWorkspace& ws, const ClothState& state, double h) {
    for (std::uint32_t p = 0; p < ws.dv.size(); ++p) {
        if (ws.dv[p].allFinite()) continue;
        StepFailure failure;
        failure.step = state.step + 1;
        failure.t = state.t;
        failure.h = h;
        failure.particles = {p};
        failure.value = ws.dv[p].norm();
        failure.limit = std::numeric_limits<double>::max();
        failure.advice = fmt::format("take a smaller step than {} s, or an implicit integrator", h);
        throw SimulationError(
            fmt::format("step {} (from {:.6g} s, {:.6g} s long): particle {} would get a velocity that is "
                        "not finite; {}",
                        failure.step, failure.t, h, p, failure.advice),
            failure);
    }
}

}  // namespace

Splitting splitting_of(const StepOptions& options) {
    switch (options.integrator) {
        case Integrator::explicit_:
            return {infinity, infinity};
        case Integrator::imex:
            return {-1.0, infinity};
        case Integrator::adaptive_imex:
            return {options.threshold, options.threshold};
        default:
            return {-1.0, -1.0};
    }
}

StepOptions step_options(const Solver& solver) {
    StepOptions options;
    options.integrator = solver.integrator;
    options.threshold = solver.threshold;
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

    // Constraints (paper Sec. 4; Baraff & Witkin 1998): S and z
    ws.base = state.x;
    ws.impulse.assign(n, Vec3::Zero());
    const StepView view{state.x, state.v, model.mass, h, model.gravity.norm()};
    constrain(model, view, state, h, ws);
    timer.lap(report.times.contact);

    // Effects that the scene calls for
    const Splitting splitting = splitting_of(options);
    if (model.self_collision) {
        self_collide(model, state.x, state.v, h, splitting.stretch_threshold, ws.self);
        timer.lap(report.times.collision);
    }
    if (model.wind) {
        ws.air.resize(model.air.corners.size());
        air_forces(model.air, *model.wind, state.t, h, model.mass, state.x, state.v, ws.air);
        add_air(model.air, ws.air, h, ws.impulse);
        timer.lap(report.times.air);
    }

    // Forces at (x, v) (Sec. 2), and the adaptive IMEX splitting (Sec. 3.5)
    extension_forces(model.springs, model.mass, state.x, state.v, h, splitting_of(options),
                     options.activation_band, ws.extension);
    limit_bend(model.bends, model.mass, h, ws.bend_limit);
    ws.bend.resize(model.bends.size());
    bend_forces(model.bends, ws.bend_limit, state.x, ws.bend);
    add_forces(model, h, ws);
    ws.drift.resize(n);
    parallel_each(n, [&](std::size_t p) { ws.drift[p] = ws.base[p] + h * state.v[p] - state.x[p]; });
    timer.lap(report.times.forces);

    // Independent components (Sec. 5)
    const SpringFamily all_families[] = {{&model.springs, &model.spring_adjacency, &ws.extension},
                                         {&ws.self.springs, &ws.self.adjacency, &ws.self.forces}};
    const std::span<const SpringFamily> families(all_families, model.self_collision ? 2 : 1);
    if (options.decompose) {
        find_components(n, families, ws.constraints, ws.parent, ws.components);
    } else {
        whole_cloth(n, ws.components);
    }
    timer.lap(report.times.graph);

    // A Δv = b (Eq. 5), then Sx = Sb, (I − S)x = (I − S)z (Eq. 9), one component at a time
    const Load load{model.mass, ws.impulse, ws.drift};
    assemble(families, load, ws.components, ws.constraints, h, ws.system);
    timer.lap(report.times.assembly);
    solve(ws.system, ws.components, ws.constraints, state.dv, options.solve, ws.solve, ws.solves);
    ws.dv.resize(n);
    parallel_each(n, [&](std::size_t row) { ws.dv[ws.components.order[row]] = ws.solve.x[row]; });
    timer.lap(report.times.solve);
    if (options.compare_whole) compare_whole(model, options, families, load, h, state, ws, report);
    timer.lap(report.times.compare);

    require_finite(ws, state, h);
    if (!model.solids.empty()) {
        find_reactions(ws);
        judge_touches(model.solids, view, ws.constraints, ws.reaction, ws.touches, state.contacts);
    }
    timer.lap(report.times.contact);

    // Δx = h (v + Δv) (Eq. 6), and the contacts' depth corrections that `base` carries
    parallel_each(n, [&](std::size_t p) {
        state.v[p] += ws.dv[p];
        state.x[p] = ws.base[p] + h * state.v[p];
    });
    state.dv = ws.dv;
    ++state.step;
    state.t += h;
    timer.lap(report.times.advance);

    report.t = state.t;
    report.components = static_cast<std::uint32_t>(ws.components.count());
    report.largest = ws.components.largest();
    for (const Constraint& c : ws.constraints.all()) ++(c.free == 0 ? report.constrained : report.partly);
    report.contacts = static_cast<std::uint32_t>(ws.touches.size());
    count_springs(families, report);
    report.self_contacts = static_cast<std::uint32_t>(ws.self.springs.size());
    report.self_distance = ws.self.least_distance;
    count_solves(ws.solves, report);
    measure(model, ws.bend_limit, state, ws.measure, report);
    timer.lap(report.times.measure);
    return report;
}

}  // namespace unravel
