#pragma once

#include <span>
#include <vector>

#include "sim/model/model.hpp"
#include "sim/model/report.hpp"
#include "sim/model/state.hpp"

namespace unravel::sim {

/// Memory of the measurements, kept between steps.
struct MeasureWorkspace {
    std::vector<float> strain;  ///< (stretch springs)
    std::vector<double> partials;
};

/// Fills strain, lowest point and energies of the state into a report. `bend` is the limit that the step
/// used.
void measure(const ClothModel& model, const BendLimit& bend, const ClothState& state, MeasureWorkspace& ws,
             StepReport& report);

/// The same of positions [m] and velocities [m/s], (particles).
void measure(const ClothModel& model, const BendLimit& bend, std::span<const Vec3> x, std::span<const Vec3> v,
             MeasureWorkspace& ws, StepReport& report);

/// What is rounding in positions, where they are (particles): far above their last bits, far below anything
/// that can be seen [m].
double position_rounding(std::span<const Vec3> x);

}  // namespace unravel::sim
