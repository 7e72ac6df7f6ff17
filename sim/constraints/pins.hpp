#pragma once

#include "sim/constraints/constraints.hpp"
#include "sim/constraints/contact.hpp"
#include "sim/model/model.hpp"
#include "sim/solids/motion.hpp"

namespace unravel::sim {

/// Whether a pin holds its particles through a step that ends at t_end [s]. A nanosecond's grace: sums of
/// step sizes end beside the time that they are to reach.
inline bool holds(const PinnedGroup& pin, double t_end) {
    return t_end <= pin.release + 1e-9;
}

/// Where a pin has its particles at one time: what they have in common.
struct PinMoment {
    double t = 0;
    double drawn = 1;                 ///< share that is left of their distances from the centre
    bool rides = false;               ///< on a body, which has gone from the start to
    Pose carried = Pose::Identity();  ///< here
    std::vector<Vec3> surface;        ///< of a body that deforms: its vertices, in its own frame [m]
    Vec3 slide{0, 0, 0};              ///< unit, the direction in which they are free; zero: in none
    Vec3 rod{0, 0, 0};                ///< m, the middle of what they slide on
};
PinMoment pin_moment(const PinnedGroup& pin, double t);

/// Where the pin has its k-th particle then [m]; of one that slides a point of the line that it is on.
Vec3 pin_place(const PinnedGroup& pin, const PinMoment& moment, std::size_t k);

/// The same motion for all its particles at once, where they move as one body.
inline bool is_rigid(const PinnedGroup& pin) {
    return pin.gather == 1 && pin.triangles.empty();
}

/// Constrains the particles of every pin not yet released so that they end the step where their motion has
/// them; of one that slides they end it somewhere on their line, and not beyond its ends.
///   t_end  s, the end of the step;   base  (particles) positions x' starts from [m]
void constrain_pins(const ClothModel& model, const StepView& view, std::span<const Vec3> base, double t_end,
                    Constraints& constraints);

}  // namespace unravel::sim
