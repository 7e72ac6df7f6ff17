#include "sim/simulate.hpp"

#include <cmath>

namespace unravel {

int steps_per_frame(const Scene& scene) {
    return static_cast<int>(std::lround(1.0 / (scene.clip.fps * scene.solver.step)));
}

Simulation start_simulation(const Scene& scene) {
    Simulation simulation;
    Placement placement;
    simulation.model = build_model(scene, placement);
    simulation.options = step_options(scene.solver);
    simulation.fps = scene.clip.fps;
    simulation.steps_per_frame = steps_per_frame(scene);
    simulation.state = initial_state(placement);
    simulation.guard = make_guard(simulation.model, simulation.state);
    return simulation;
}

void restore(Simulation& simulation, const FrameRecord& record) {
    simulation.state = record.state;
    simulation.frame = record.frame;
}

FrameRecord present_record(const Simulation& simulation) {
    const std::size_t n = simulation.model.size();
    FrameRecord record;
    record.frame = simulation.frame;
    record.state = simulation.state;
    record.free.assign(n, 3);
    for (const Constraint& c : simulation.ws.constraints.all()) record.free[c.particle] = c.free;
    record.component = simulation.ws.components.label;
    record.springs = simulation.ws.extension.state;
    record.solves = simulation.ws.solves;
    // Before the first step nothing is decomposed yet.
    record.component.resize(n, 0);
    record.springs.resize(simulation.model.springs.size(), SpringState::inactive);
    return record;
}

StepReport next_step(Simulation& simulation) {
    const int rate = simulation.fps * simulation.steps_per_frame;
    StepReport report = guarded_step(simulation.model, simulation.options, 1.0 / rate, simulation.state,
                                     simulation.ws, simulation.guard);
    simulation.state.t = static_cast<double>(simulation.state.step) / rate;
    report.t = simulation.state.t;
    return report;
}

FrameRecord next_record(Simulation& simulation) {
    std::vector<StepReport> reports;
    for (int k = 0; k < simulation.steps_per_frame; ++k) reports.push_back(next_step(simulation));
    ++simulation.frame;
    FrameRecord record = present_record(simulation);
    record.reports = std::move(reports);
    return record;
}

}  // namespace unravel
