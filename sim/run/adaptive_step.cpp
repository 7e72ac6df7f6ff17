#include "sim/run/adaptive_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace unravel::sim {

namespace {

// A step that stays below this share of its bounds is calm: the next may be twice as long.
constexpr double calm_share = 0.25;
// Halvings beyond this are below any time that matters.
constexpr int most_halvings = 20;

// The step's strain and error, each over its bound: above 1 it is rejected.
double excess(const AdaptiveStep& settings, const StepReport& report, const ClothState& before,
              const ClothState& after) {
    double most = std::max(0.0, report.max_strain - std::max(before.strain, 0.0)) / settings.max_strain;
    if (settings.tolerance > 0 && before.h_previous > 0) {
        for (std::size_t p = 0; p < after.x.size(); ++p) {
            const Vec3 change = after.dv[p] - report.h / before.h_previous * before.dv[p];
            most = std::max(most, 0.5 * report.h * change.norm() / settings.tolerance);
        }
    }
    return most;
}

}  // namespace

StepReport adaptive_step(Simulation& simulation, const AdaptiveStep& settings, double rate) {
    ClothState& state = simulation.state;
    const int deepest = std::clamp(
        static_cast<int>(std::floor(std::log2(1.0 / (rate * settings.smallest)) + 1e-9)), 0, most_halvings);
    const std::uint32_t parts = 1u << deepest;
    for (std::uint32_t rejected = 0;; ++rejected) {
        const std::uint32_t length = parts >> state.halvings;
        const double h = static_cast<double>(length) / parts / rate;
        const bool smallest = state.halvings >= deepest;
        const std::uint8_t halvings = state.halvings;
        const Guard guard = simulation.guard;
        double over = 0;
        StepReport report;
        try {
            report =
                guarded_step(simulation.model, simulation.options, h, state, simulation.ws, simulation.guard);
            over = excess(settings, report, simulation.ws.before, state);
        } catch (const SimulationError&) {
            if (smallest) throw;
            state.halvings = static_cast<std::uint8_t>(halvings + 1);
            continue;
        }
        if (over > 1 && !smallest) {
            std::swap(state, simulation.ws.before);
            simulation.guard = guard;
            state.halvings = static_cast<std::uint8_t>(halvings + 1);
            continue;
        }
        report.rejected += rejected;
        state.strain = report.max_strain;
        state.h_previous = h;
        state.part += length;
        if (state.part == parts) {
            ++state.whole_steps;
            state.part = 0;
        }
        if (over < calm_share && state.halvings > 0 && state.part % (2 * length) == 0) --state.halvings;
        state.t = (static_cast<double>(state.whole_steps) + static_cast<double>(state.part) / parts -
                   static_cast<double>(simulation.settling)) /
                  rate;
        report.t = state.t;
        return report;
    }
}

}  // namespace unravel::sim
