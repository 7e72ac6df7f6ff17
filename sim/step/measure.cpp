#include "sim/step/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unravel::sim {

void measure(const ClothModel& model, const BendLimit& bend, const ClothState& state, MeasureWorkspace& ws,
             StepReport& report) {
    measure(model, bend, state.x, state.v, ws, report);
}

void measure(const ClothModel& model, const BendLimit& bend, std::span<const Vec3> x, std::span<const Vec3> v,
             MeasureWorkspace& ws, StepReport& report) {
    const ExtensionSprings& springs = model.springs;
    const auto sum = [&](std::size_t size, const auto& f) {
        return parallel_sum(size, ws.partials, [&](std::size_t begin, std::size_t end) {
            double partial = 0;
            for (std::size_t k = begin; k < end; ++k) partial += f(k);
            return partial;
        });
    };
    ws.strain.resize(springs.stretch_count);
    report.potential = sum(springs.size(), [&](std::size_t s) {
        const double length = (x[springs.j[s]] - x[springs.i[s]]).norm();
        if (s < springs.stretch_count) ws.strain[s] = static_cast<float>(length / springs.rest[s] - 1.0);
        return extension_energy(length, springs.rest[s], springs.stiffness[s]);
    });
    report.potential += sum(model.bends.size(), [&](std::size_t s) {
        const double length = (x[model.bends.j[s]] - x[model.bends.i[s]]).norm();
        return bend_energy(length, model.bends.rest[s], model.bends.stiffness[s], bend.slope[s],
                           bend.crossing[s]);
    });
    report.potential -=
        sum(model.size(), [&](std::size_t p) { return model.mass[p] * model.gravity.dot(x[p]); });
    report.kinetic =
        sum(model.size(), [&](std::size_t p) { return 0.5 * model.mass[p] * v[p].squaredNorm(); });

    report.lowest = std::numeric_limits<double>::infinity();
    for (const Vec3& position : x) report.lowest = std::min(report.lowest, position.y());
    if (ws.strain.empty()) return;
    const auto p99 =
        ws.strain.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(ws.strain.size() - 1));
    std::nth_element(ws.strain.begin(), p99, ws.strain.end());
    report.p99_strain = *p99;
    report.max_strain = *std::max_element(p99, ws.strain.end());
}

double position_rounding(std::span<const Vec3> x) {
    double farthest = 0;
    for (const Vec3& position : x) farthest = std::max(farthest, position.cwiseAbs().maxCoeff());
    return 1e-12 * farthest;
}

}  // namespace unravel::sim
