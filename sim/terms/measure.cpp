#include "sim/terms/measure.hpp"

#include <algorithm>
#include <limits>

namespace unravel::sim {

void measure(const ClothModel& model, const ForceMemory& forces, std::span<const Vec3> x,
             std::span<const Vec3> v, MeasureWorkspace& ws, StepReport& report) {
    report.potential = 0;
    each_term(model, [&](const ForceTerm& term) {
        if (term.measure) term.measure(model, x, forces, ws, report);
    });
    report.kinetic =
        ws.sum(model.size(), [&](std::size_t p) { return 0.5 * model.mass[p] * v[p].squaredNorm(); });
    report.lowest = std::numeric_limits<double>::infinity();
    for (const Vec3& position : x) report.lowest = std::min(report.lowest, position.y());
}

double position_rounding(std::span<const Vec3> x) {
    double farthest = 0;
    for (const Vec3& position : x) farthest = std::max(farthest, position.cwiseAbs().maxCoeff());
    return 1e-12 * farthest;
}

}  // namespace unravel::sim
