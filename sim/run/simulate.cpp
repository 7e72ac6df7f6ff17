#include "sim/run/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "sim/run/adaptive_step.hpp"
#include "sim/run/passages.hpp"
#include "sim/step/trace.hpp"

namespace unravel::sim {

namespace {

// Cells from which explicit steps keep a part of the air's force, as the simulation stands.
std::uint32_t count_held_air(const Simulation& simulation) {
    const ForceSettings& settings = simulation.ws.plan.step.forces.settings;
    if (!settings.all_explicit) return 0;
    const ClothState& state = simulation.state;
    return held_back(air_cells(simulation.model), *simulation.model.wind, state.t, settings.h,
                     simulation.model.mass, state.x, state.v);
}

}  // namespace

int steps_per_frame(const Scene& scene) {
    return static_cast<int>(std::lround(1.0 / (scene.clip.fps.per_second() * scene.solver.step)));
}

Simulation start_simulation(const Scene& scene) {
    Simulation simulation;
    Placement placement;
    simulation.model = build_model(scene, placement);
    simulation.options = step_options(scene.solver);
    simulation.fps = scene.clip.fps;
    simulation.steps_per_frame = steps_per_frame(scene);
    simulation.state = initial_state(placement);
    simulation.adaptive = scene.solver.adaptive;
    simulation.settling = static_cast<std::uint64_t>(
        std::lround(scene.clip.settle * simulation.fps.per_second() * simulation.steps_per_frame));
    if (simulation.settling > 0)
        simulation.state.t = -static_cast<double>(simulation.settling) /
                             (simulation.fps.per_second() * simulation.steps_per_frame);
    plan_step(simulation.model, simulation.options, scene.solver.step, simulation.ws);
    simulation.guard = make_guard(simulation.model, simulation.state, scene.solver.step);
    return simulation;
}

bool settle(Simulation& simulation, const std::function<bool()>& keep_on) {
    if (simulation.settling == 0) return true;
    while (simulation.state.whole_steps < simulation.settling) {
        if (!keep_on()) return false;
        next_step(simulation);
    }
    simulation.settling = 0;
    simulation.state.whole_steps = 0;
    simulation.state.t = 0;
    return true;
}

void restore(Simulation& simulation, const FrameRecord& record) {
    simulation.settling = 0;
    simulation.state = record.state;
    simulation.frame = record.frame;
    // Settled or pushed, it has been through more than its start tells.
    simulation.guard.total = record.energy;
    simulation.guard.energy = record.energy_limit;
}

FrameRecord present_record(const Simulation& simulation) {
    const std::size_t n = simulation.model.size();
    FrameRecord record;
    record.frame = simulation.frame;
    record.state = simulation.state;
    record.energy = simulation.guard.total;
    record.energy_limit = simulation.guard.energy;
    record.free.assign(n, 3);
    const StepTrace trace = trace_of(simulation.model, simulation.ws);
    for (const Constraint& c : trace.constraints.all()) record.free[c.particle] = c.free;
    record.component = trace.components.label;
    record.springs.assign(trace.springs.begin(), trace.springs.end());
    record.solves = trace.solves;
    // Before the first step nothing is decomposed yet.
    record.component.resize(n, 0);
    record.springs.resize(simulation.model.springs.size(), SpringState::inactive);
    return record;
}

StepReport next_step(Simulation& simulation) {
    const double rate = simulation.fps.per_second() * simulation.steps_per_frame;
    ClothState& state = simulation.state;
    if (simulation.adaptive) return adaptive_step(simulation, *simulation.adaptive, rate);
    StepReport report = guarded_step(simulation.model, simulation.options, 1.0 / rate, state, simulation.ws,
                                     simulation.guard);
    ++state.whole_steps;
    report.t = state.t =
        (static_cast<double>(state.whole_steps) - static_cast<double>(simulation.settling)) / rate;
    return report;
}

FrameRecord next_record(Simulation& simulation) {
    settle(simulation);
    std::vector<StepReport> reports;
    const auto due = static_cast<std::uint64_t>(simulation.frame + 1) * simulation.steps_per_frame;
    while (simulation.state.whole_steps < due) reports.push_back(next_step(simulation));
    ++simulation.frame;
    if (simulation.model.contact && !reports.empty()) {
        const Passages passages = find_passages(simulation.model, simulation.state.t, simulation.state.x);
        reports.back().crossings = passages.cloth_count();
        reports.back().in_solids = passages.solids;
        reports.back().deepest = passages.deepest;
    }
    if (simulation.model.wind && !reports.empty()) reports.back().air_held = count_held_air(simulation);
    FrameRecord record = present_record(simulation);
    record.reports = std::move(reports);
    return record;
}

}  // namespace unravel::sim
