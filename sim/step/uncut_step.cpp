#include "sim/self_collision/solid_cuts.hpp"
#include "sim/step/stage.hpp"

namespace unravel::sim {

namespace {

// Parts that a step is taken in at most; a power of two.
constexpr int most_parts = 64;
// Of those, the fewest that are taken at once where particles go round an edge: a contact takes what goes
// along its normal of the step's start, and the rest is on where it has turned, so that too large a step
// loses speed there. Nothing is passed for it, so that it need not be met to the last.
constexpr int turning_length = 8;

// Whether a step was too long: more of the cloth is in solids, or behind one, than when it began, or it went
// round an edge; `length` of it could still be less.
bool is_too_long(const ClothModel& model, const ClothState& before, const ClothState& after, int length) {
    if (length <= 1) return false;
    const Ways ways = judge_ways(model, before.t, before.x, after.t, after.x);
    if (ways.through > 0 || (ways.turned > 0 && length > turning_length)) return true;
    const std::uint64_t cuts = count_cuts(model, after.t, after.x);
    return cuts > 0 && cuts > count_cuts(model, before.t, before.x);
}

}  // namespace

StepReport uncut_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                      StepWorkspace& ws) {
    StepReport report = coupled_step(model, options, h, state, ws);
    if (!is_too_long(model, ws.before, state, most_parts)) return report;
    std::swap(state, ws.before);
    ClothState start = state;
    StageTimes times = report.times;
    std::uint32_t parts = 0, rejected = 1;
    try {
        for (int done = 0, length = most_parts / 2; done < most_parts;) {
            heed(options.solve.stop);
            StepOptions each = options;
            each.measure = options.measure && done + length == most_parts;
            report = coupled_step(model, each, h * length / most_parts, state, ws);
            times += report.times;
            if (is_too_long(model, ws.before, state, length)) {
                std::swap(state, ws.before);
                length /= 2;
                ++rejected;
                continue;
            }
            done += length;
            ++parts;
            // What was met once is mostly past: longer parts are tried again.
            if (done % (2 * length) == 0 && length < most_parts / 2) length *= 2;
        }
    } catch (const SimulationError&) {
        state = std::move(start);
        throw;
    }
    join_parts(start, h, parts, times, state, report);
    report.rejected = rejected;
    ws.before = std::move(start);
    return report;
}

}  // namespace unravel::sim
