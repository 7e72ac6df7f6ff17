#pragma once

#include "sim/constraints/constraints.hpp"
#include "sim/constraints/contact.hpp"
#include "sim/model/model.hpp"

namespace unravel::sim {

/// Whether a pin holds its particles through a step that ends at t_end [s]. A nanosecond's grace: sums of
/// step sizes end beside the time that they are to reach.
inline bool holds(const PinnedGroup& pin, double t_end) {
    return t_end <= pin.release + 1e-9;
}

/// Constrains the particles of every pin not yet released so that they end the step where their motion has
/// them.
///   t_end  s, the end of the step;   base  (particles) positions x' starts from [m]
void constrain_pins(const ClothModel& model, const StepView& view, std::span<const Vec3> base, double t_end,
                    Constraints& constraints);

}  // namespace unravel::sim
