#pragma once

#include <span>
#include <vector>

#include "sim/model/state.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

/// Memory of the measurements, kept between steps.
struct MeasureWorkspace {
    std::vector<float> strain;     ///< (stretch springs)
    std::vector<double> partials;  ///< (chunks)
    /// Σ f(k) over [0, size), in an order that no number of threads changes.
    template <typename F>
    double sum(std::size_t size, const F& f) {
        return parallel_sum(size, partials, [&](std::size_t begin, std::size_t end) {
            double partial = 0;
            for (std::size_t k = begin; k < end; ++k) partial += f(k);
            return partial;
        });
    }
};

/// Fills strain, lowest point and energies of a state into a report: positions [m] and velocities [m/s],
/// (particles). `forces` is as the step prepared it.
void measure(const ClothModel& model, const ForceMemory& forces, std::span<const Vec3> x,
             std::span<const Vec3> v, MeasureWorkspace& ws, StepReport& report);
inline void measure(const ClothModel& model, const ForceMemory& forces, const ClothState& state,
                    MeasureWorkspace& ws, StepReport& report) {
    measure(model, forces, state.x, state.v, ws, report);
}

/// What is rounding in positions, where they are (particles): far above their last bits, far below anything
/// that can be seen [m].
double position_rounding(std::span<const Vec3> x);

}  // namespace unravel::sim
