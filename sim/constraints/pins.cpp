#include "sim/constraints/pins.hpp"

#include <algorithm>
#include <cmath>

#include "sim/mesh/mesh_solid.hpp"

namespace unravel::sim {

namespace {

// A particle that slides is free along the line that its target lies on. One that would leave the rod in this
// step is held at its end.
Constraint slide_along(const PinnedGroup& pin, const PinMoment& moment, std::uint32_t p, const StepView& view,
                       const Vec3& base, const Vec3& target) {
    const Vec3& along = moment.slide;
    const Vec3 wanted = (target - base) / view.h - view.v[p];
    const Vec3 across = wanted - along * along.dot(wanted);
    if (pin.reach > 0) {
        const double here = along.dot(base - moment.rod), speed = along.dot(view.v[p]);
        const double there = here + view.h * speed;
        if (std::abs(there) > pin.reach && there * speed > 0) {
            const double stop = (std::clamp(there, -pin.reach, pin.reach) - here) / view.h - speed;
            return {p, 0, Mat3::Zero(), across + stop * along};
        }
    }
    return {p, 1, along * along.transpose(), across};
}

}  // namespace

PinMoment pin_moment(const PinnedGroup& pin, double t) {
    PinMoment moment;
    moment.t = t;
    if (pin.gather != 1) {
        const double s = std::clamp((t - pin.gather_begin) / pin.gather_time, 0.0, 1.0);
        moment.drawn = 1 + (pin.gather - 1) * s * s * (3 - 2 * s);
    }
    moment.slide = pin.slide;
    moment.rod = pin.rod;
    if (pin.slides() && !pin.motion.empty())
        moment.slide = rotation_from_degrees(sample_motion(pin.motion, t).degrees) * pin.slide;
    if (!pin.carried.by) return moment;
    moment.rides = true;
    if (!pin.triangles.empty()) pin.carried.by->geometry->positions_at(t, moment.surface);
    moment.carried = carried_pose(pin.carried, t);
    moment.slide = moment.carried.linear() * moment.slide;
    moment.rod = moment.carried * pin.rod;
    return moment;
}

Vec3 pin_place(const PinnedGroup& pin, const PinMoment& moment, std::size_t k) {
    const Vec3 start =
        moment.drawn == 1 ? pin.start[k] : Vec3(pin.centre + moment.drawn * (pin.start[k] - pin.centre));
    const Vec3 moved = moved_point(pin.motion, pin.centre, start, moment.t);
    if (!moment.rides) return moved;
    if (pin.triangles.empty()) return moment.carried * moved;
    return ride_on_triangle(*pin.carried.by, pin.triangles[k], moment.surface, moment.t) * moved;
}

void constrain_pins(const ClothModel& model, const StepView& view, std::span<const Vec3> base, double t_end,
                    Constraints& constraints) {
    for (const PinnedGroup& pin : model.pins) {
        if (!holds(pin, t_end)) continue;
        const PinMoment moment = pin_moment(pin, t_end);
        for (std::size_t k = 0; k < pin.particles.size(); ++k) {
            const std::uint32_t p = pin.particles[k];
            if (constraints.find(p)) continue;  // the first of several pins decides
            const Vec3 target = pin_place(pin, moment, k);
            constraints.add(pin.slides()
                                ? slide_along(pin, moment, p, view, base[p], target)
                                : Constraint{p, 0, Mat3::Zero(), (target - base[p]) / view.h - view.v[p]});
        }
    }
}

}  // namespace unravel::sim
