#include <algorithm>
#include <cmath>

#include "sim/step/explicit_limit.hpp"
#include "sim/step/stage.hpp"

namespace unravel::sim {

namespace {

// Stretch and shear springs at x, as the explicit treatment has them.
void classify(const ExtensionSprings& springs, std::span<const Vec3> x, std::vector<SpringState>& out,
              StepReport& report) {
    out.resize(springs.size());
    parallel_each(springs.size(), [&](std::size_t s) {
        const double rest = springs.rest[s];
        const bool taut = (x[springs.j[s]] - x[springs.i[s]]).squaredNorm() > rest * rest;
        out[s] = taut ? SpringState::explicit_ : SpringState::inactive;
    });
    const auto taut = std::count(out.begin(), out.end(), SpringState::explicit_);
    report.explicit_ = static_cast<std::uint32_t>(taut);
    report.inactive = static_cast<std::uint32_t>(out.size()) - report.explicit_;
}

StepReport swept_step(const ClothModel& model, const StepOptions& options, double h, int substeps,
                      ClothState& state, StepWorkspace& ws) {
    StepReport report;
    StageTimer timer;
    report.step = state.step + 1;
    report.h = h;
    ws.swept = true;
    ws.coupled = false;
    ClothState& next = ws.before;
    begin_next(state, h, next);
    ws.sweep.run(model, state, substeps, next, ws.constraints, report.contacts);
    require_finite(next.v, state, h);
    parallel_each(model.size(), [&](std::size_t p) { next.dv[p] = next.v[p] - state.v[p]; });
    timer.lap(report.times.advance);
    if (options.measure) classify(model.springs, state.x, ws.extension.state, report);
    std::swap(state, next);

    lone_particles(model.size(), ws.constraints, ws.components);
    ws.solves.assign(ws.components.count(), {});
    timer.lap(report.times.graph);
    report.t = state.t;
    report.substeps = static_cast<std::uint32_t>(substeps);
    report.components = static_cast<std::uint32_t>(ws.components.count());
    report.largest = ws.components.largest();
    for (const Constraint& c : ws.constraints.all()) ++(c.free == 0 ? report.constrained : report.partly);
    if (options.measure) measure(model, ws.bend_limit, state, ws.measure, report);
    timer.lap(report.times.measure);
    return report;
}

// One step after the other; the report is the last one's, with all their times.
StepReport substeps_in_turn(const ClothModel& model, const StepOptions& options, double h, int substeps,
                            ClothState& state, StepWorkspace& ws) {
    if (substeps == 1) return coupled_step(model, options, h, state, ws);
    ClothState start = state;
    StageTimes times;
    StepReport report;
    try {
        for (int k = 0; k < substeps; ++k) {
            StepOptions each = options;
            each.measure = options.measure && k + 1 == substeps;
            report = coupled_step(model, each, h / substeps, state, ws);
            times += report.times;
        }
    } catch (const SimulationError&) {
        state = std::move(start);
        throw;
    }
    state.step = report.step = start.step + 1;
    state.t = report.t = start.t + h;
    state.h_previous = report.h = h;
    report.times = times;
    report.substeps = static_cast<std::uint32_t>(substeps);
    parallel_each(model.size(), [&](std::size_t p) { state.dv[p] = state.v[p] - start.v[p]; });
    ws.before = std::move(start);
    return report;
}

}  // namespace

double substeps_of(const ClothModel& model, const StepOptions& options, double h, StepWorkspace& ws) {
    if (options.substeps > 0) return options.substeps;
    if (ws.explicit_step == 0) {
        StepOptions whole = options;
        whole.substeps = 1;
        ws.explicit_step = explicit_limit(model, whole, h).step;
    }
    return stable_substeps(h, ws.explicit_step);
}

StepReport explicit_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                         StepWorkspace& ws) {
    // Who starts a run has refused what is more than most_substeps.
    const int substeps = static_cast<int>(std::min(substeps_of(model, options, h, ws), 1e9));
    limit_bend(model.bends, model.mass, h / substeps, ws.bend_limit);
    if (options.sweep && ws.sweep.prepare(model, ws.bend_limit, h / substeps))
        return swept_step(model, options, h, substeps, state, ws);
    return substeps_in_turn(model, options, h, substeps, state, ws);
}

}  // namespace unravel::sim
