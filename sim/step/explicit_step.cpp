#include <algorithm>

#include "sim/step/stage.hpp"

namespace unravel::sim {

namespace {

// Stretch and shear springs at x, as the explicit treatment has them.
void classify(const ExtensionSprings& springs, std::span<const Vec3> x, std::vector<SpringState>& out,
              StepReport& report) {
    out.resize(springs.size());
    parallel_each(springs.size(), [&](std::size_t s) {
        const double rest = springs.rest[s];
        const bool taut = is_taut((x[springs.j[s]] - x[springs.i[s]]).squaredNorm(), rest * rest);
        out[s] = SpringSplit{true, taut, taut, false, true}.state();
    });
    const auto taut = std::count(out.begin(), out.end(), SpringState::explicit_);
    report.explicit_ = static_cast<std::uint32_t>(taut);
    report.inactive = static_cast<std::uint32_t>(out.size()) - report.explicit_;
}

}  // namespace

StepReport swept_step(const ClothModel& model, const StepOptions& options, double h, int substeps,
                      ClothState& state, StepWorkspace& ws) {
    StepReport report;
    StageTimer timer;
    report.step = state.step + 1;
    report.h = h;
    prepare_terms(model, h / substeps, ws.forces.memory);
    ws.sweep.prepare(model, ws.forces.memory, h / substeps);
    std::swap(state, ws.before);
    const ClothState& before = ws.before;
    begin_next(before, h, state);
    ws.sweep.run(model, before, substeps, options.solve.stop, state, ws.constraints, report.contacts);
    try {
        require_finite(state.v, before, h);
    } catch (const SimulationError&) {
        std::swap(state, ws.before);
        throw;
    }
    parallel_each(model.size(), [&](std::size_t p) { state.dv[p] = state.v[p] - before.v[p]; });
    timer.lap(report.times.advance);
    if (options.measure) classify(model.springs, before.x, ws.forces.memory.springs.state, report);
    ws.linear.coupled = false;
    lone_particles(model.size(), ws.constraints, ws.linear.components);
    ws.linear.solves.assign(ws.linear.components.count(), {});
    timer.lap(report.times.graph);
    report.t = state.t;
    report.substeps = static_cast<std::uint32_t>(substeps);
    finish_report(model, options, state, timer, ws, report);
    return report;
}

StepReport substeps_in_turn(const ClothModel& model, const StepOptions& options, double h, int substeps,
                            ClothState& state, StepWorkspace& ws) {
    if (substeps == 1) return coupled_step(model, options, h, state, ws);
    ClothState start = state;
    StageTimes times;
    StepReport report;
    try {
        for (int k = 0; k < substeps; ++k) {
            heed(options.solve.stop);
            StepOptions each = options;
            each.measure = options.measure && k + 1 == substeps;
            report = coupled_step(model, each, h / substeps, state, ws);
            times += report.times;
        }
    } catch (const SimulationError&) {
        state = std::move(start);
        throw;
    }
    join_parts(start, h, static_cast<std::uint32_t>(substeps), times, state, report);
    ws.before = std::move(start);
    return report;
}

void join_parts(const ClothState& start, double h, std::uint32_t parts, const StageTimes& times,
                ClothState& state, StepReport& report) {
    state.step = report.step = start.step + 1;
    state.t = report.t = start.t + h;
    state.h_previous = report.h = h;
    report.times = times;
    report.substeps = parts;
    parallel_each(state.v.size(), [&](std::size_t p) { state.dv[p] = state.v[p] - start.v[p]; });
}

}  // namespace unravel::sim
