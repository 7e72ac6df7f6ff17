#include "sim/constraints/pins.hpp"

namespace unravel::sim {

void constrain_pins(const ClothModel& model, const StepView& view, std::span<const Vec3> base, double t_end,
                    Constraints& constraints) {
    for (const PinnedGroup& pin : model.pins) {
        if (!holds(pin, t_end)) continue;
        for (std::size_t k = 0; k < pin.particles.size(); ++k) {
            const std::uint32_t p = pin.particles[k];
            if (constraints.find(p)) continue;  // the first of several pins decides
            const Vec3 target = moved_point(pin.motion, pin.centre, pin.start[k], t_end);
            constraints.add({p, 0, Mat3::Zero(), (target - base[p]) / view.h - view.v[p]});
        }
    }
}

}  // namespace unravel::sim
