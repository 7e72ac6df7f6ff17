#include "sim/run/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "sim/run/adaptive_step.hpp"
#include "sim/step/trace.hpp"

namespace unravel::sim {

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
    plan_step(simulation.model, simulation.options, scene.solver.step, simulation.ws);
    simulation.guard = make_guard(simulation.model, simulation.state, scene.solver.step);
    return simulation;
}

void restore(Simulation& simulation, const FrameRecord& record) {
    simulation.state = record.state;
    simulation.frame = record.frame;
    if (record.reports.empty()) return;
    simulation.guard.total = record.reports.back().kinetic + record.reports.back().potential;
}

FrameRecord present_record(const Simulation& simulation) {
    const std::size_t n = simulation.model.size();
    FrameRecord record;
    record.frame = simulation.frame;
    record.state = simulation.state;
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
    report.t = state.t = static_cast<double>(state.whole_steps) / rate;
    return report;
}

FrameRecord next_record(Simulation& simulation) {
    std::vector<StepReport> reports;
    const auto due = static_cast<std::uint64_t>(simulation.frame + 1) * simulation.steps_per_frame;
    while (simulation.state.whole_steps < due) reports.push_back(next_step(simulation));
    ++simulation.frame;
    FrameRecord record = present_record(simulation);
    record.reports = std::move(reports);
    return record;
}

}  // namespace unravel::sim
