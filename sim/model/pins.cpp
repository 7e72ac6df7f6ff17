#include "sim/model/pins.hpp"

#include <limits>

#include "sim/mesh/placement.hpp"
#include "sim/solids/motion.hpp"

namespace unravel::sim {

namespace {

// How much nearer to their middle the particles come whose row is drawn together to `width`.
double gathered_share(const PinnedGroup& group, bool ring, double width) {
    double length = 0;
    for (std::size_t k = ring ? 0 : 1; k < group.start.size(); ++k)
        length += (group.start[k] - group.start[k > 0 ? k - 1 : group.start.size() - 1]).norm();
    return length > 0 ? width / length : 1;
}

// What the pin rides and slides on.
void attach(const Pin& pin, PinnedGroup& group) {
    group.carried = pin.carried;
    if (!pin.slide.isZero(0)) group.slide = pin.slide.normalized();
    if (!pin.carried.by) return;
    const Solid& body = *pin.carried.by;
    if (!pin.rod.empty()) {
        const Pose rod = solid_pose(body, 0);
        group.slide = rod.linear().col(1);
        group.rod = rod.translation();
        group.reach = 0.5 * body.height;
    }
    if (carrying_triangle(body, group.centre) < 0) return;
    for (const Vec3& x : group.start) group.triangles.push_back(carrying_triangle(body, x));
}

}  // namespace

void add_pins(const Cloth& cloth, const ClothPatch& patch, double begin, const Placement& placement,
              std::vector<PinnedGroup>& groups) {
    for (const Pin& pin : cloth.pins) {
        PinnedGroup group;
        for (const std::size_t index : pinned_particles(cloth, pin)) {
            group.particles.push_back(patch.first + static_cast<std::uint32_t>(index));
            group.start.push_back(placement.x[group.particles.back()]);
            group.centre += group.start.back();
        }
        if (group.particles.empty()) continue;
        group.centre /= static_cast<double>(group.particles.size());
        group.motion = pin.motion;
        group.release = pin.release.value_or(std::numeric_limits<double>::infinity());
        if (pin.gather) {
            group.gather = gathered_share(group, patch.tube, *pin.gather);
            group.gather_begin = begin;
            group.gather_time = pin.gather_time;
        }
        attach(pin, group);
        groups.push_back(std::move(group));
    }
}

}  // namespace unravel::sim
