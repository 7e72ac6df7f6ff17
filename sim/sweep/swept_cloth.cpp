#include "sim/sweep/swept_cloth.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "sim/constraints/pins.hpp"
#include "sim/solids/motion.hpp"
#include "sim/sweep/row_forces.hpp"

namespace unravel::sim {

namespace {

// From the start to where a pin that moves as one body has its particles at time t.
Pose pin_pose(const PinnedGroup& pin, double t) {
    Pose pose = Pose::Identity();
    if (!pin.motion.empty()) {
        const MotionSample sample = sample_motion(pin.motion, t);
        pose.linear() = rotation_from_degrees(sample.degrees);
        pose.translation() = pin.centre + sample.displacement - pose.linear() * pin.centre;
    }
    return pin.carried.by ? carried_pose(pin.carried, t) * pose : pose;
}

}  // namespace

void place_pins(const ClothModel& model, SweptCloth& cloth) {
    cloth.pins.assign(cloth.rows(), {});
    for (std::uint32_t g = 0; g < model.pins.size(); ++g) {
        const PinnedGroup& group = model.pins[g];
        for (std::size_t k = 0; k < group.particles.size(); ++k) {
            const std::uint32_t p = group.particles[k] - cloth.patch.first;
            if (group.particles[k] < cloth.patch.first || p >= cloth.patch.count()) continue;
            cloth.pins[p / cloth.columns()].push_back({p % static_cast<std::uint32_t>(cloth.columns()), g,
                                                       static_cast<std::uint32_t>(k), group.start[k]});
        }
    }
}

void plan_substeps(const ClothModel& model, double t, double h, int count, std::vector<SweepSubstep>& out) {
    out.resize(static_cast<std::size_t>(count));
    for (std::size_t s = 0; s < out.size(); ++s) {
        const double begin = t + static_cast<double>(s) * h;
        SweepSubstep& substep = out[s];
        substep.wind = row_wind(model, begin, h);
        if (!model.solids.empty()) pose_substep(model.solids, begin, h, substep.solids);
        substep.pins.clear();
        substep.holds.clear();
        substep.moments.clear();
        const bool rigid = std::ranges::all_of(model.pins, is_rigid);
        for (const PinnedGroup& pin : model.pins) {
            substep.pins.push_back(is_rigid(pin) ? pin_pose(pin, begin + h) : Pose::Identity());
            if (!rigid) substep.moments.push_back(pin_moment(pin, begin + h));
            substep.holds.push_back(holds(pin, begin + h));
        }
    }
}

void take_state(const ClothState& state, SweptCloth& cloth) {
    load_rows(state.x, state.v, cloth);
    if (cloth.stretches == 0) return;
    for (RowContacts& contacts : cloth.contacts) {
        contacts.clearance = -1;
        contacts.contacts.clear();
    }
    for (const Contact& contact : state.contacts) {
        const std::uint32_t p = contact.particle - cloth.patch.first;
        if (contact.particle < cloth.patch.first || p >= cloth.patch.count()) continue;
        const std::size_t row = p / cloth.columns(), column = p % cloth.columns();
        Contact local = contact;
        local.particle = static_cast<std::uint32_t>(column % contact_columns);
        cloth.contacts[row * cloth.stretches + column / contact_columns].contacts.push_back(local);
    }
}

void give_state(SweptCloth& cloth, ClothState& next, Constraints& constraints, std::uint32_t& touches) {
    tbb::parallel_for(std::size_t{0}, cloth.rows(), [&](std::size_t row) {
        const std::size_t first = cloth.patch.first + row * cloth.columns();
        const Row x = cloth.x(row), v = cloth.v(row);
        for (std::size_t i = 0; i < cloth.columns(); ++i) {
            next.x[first + i] = {x[0][i], x[1][i], x[2][i]};
            next.v[first + i] = {v[0][i], v[1][i], v[2][i]};
        }
    });
    for (std::size_t k = 0; k < cloth.contacts.size(); ++k) {
        const std::size_t row = k / cloth.stretches, column = k % cloth.stretches * contact_columns;
        const auto first = static_cast<std::uint32_t>(cloth.patch.first + row * cloth.columns() + column);
        for (Contact contact : cloth.contacts[k].contacts) {
            contact.particle += first;
            next.contacts.push_back(contact);
        }
        for (Constraint constraint : cloth.contacts[k].constraints) {
            constraint.particle += first;
            constraints.add(constraint);
        }
        touches += cloth.contacts[k].touches;
    }
}

}  // namespace unravel::sim
