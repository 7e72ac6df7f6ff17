#include "sim/sweep/group_sweep.hpp"

#include <algorithm>
#include <thread>

namespace unravel::sim {

namespace {

void wait(const std::atomic<std::size_t>& rows, std::size_t needed) {
    for (int k = 0; rows.load(std::memory_order_acquire) < needed; ++k) {
        if (k > 64) std::this_thread::yield();
    }
}

}  // namespace

void GroupSweep::run(std::size_t group, std::atomic<std::size_t>* passed, SweepWorker& worker) {
    const std::size_t first = group * levels_, count = std::min(levels_, substeps_.size() - first);
    const std::size_t rows = cloth_.rows();
    worker.forces.assign(count * rows_in_flight * 3 * cloth_.stride, 0.0);
    for (std::size_t front = 0; front < rows + sweep_lag * (count - 1); ++front) {
        for (std::size_t level = 0; level < count; ++level) {
            if (front < sweep_lag * level || front - sweep_lag * level >= rows) continue;
            const std::size_t row = front - sweep_lag * level;
            if (level == 0 && group > 0 && passed)
                wait(passed[group - 1], std::min(row + sweep_lag + 1, rows));
            move(row, substeps_[first + level], level, worker);
            if (passed && level + 1 == count) passed[group].store(row + 1, std::memory_order_release);
        }
    }
}

// All springs and cells that begin in a row; then all of the row's forces are there, and it moves.
void GroupSweep::move(std::size_t row, const SweepSubstep& substep, std::size_t level, SweepWorker& worker) {
    const RowRing forces{worker.forces.data() + level * rows_in_flight * 3 * cloth_.stride, cloth_.stride};
    const RowPass pass{cloth_, cloth_.tables, substep.wind, forces, 0};
    for (const RowVersion* const term : cloth_.terms) term->add(pass, row);
    const Row f = forces.row(row);
    if (cloth_.patch.tube) {
        for (double* const y : f) {
            for (std::size_t k = 0; k < seam_margin / 2; ++k) {
                y[k] += y[cloth_.columns() + k];
                y[cloth_.columns() + k] = 0;
            }
        }
    }
    advance(row, substep, f, worker);
    cloth_.repeat_over_seam(row);
}

Vec3 GroupSweep::place_of(const RowPin& pin, const SweepSubstep& substep) const {
    const PinnedGroup& group = model_.pins[pin.group];
    return is_rigid(group) ? substep.pins[pin.group] * pin.start
                           : pin_place(group, substep.moments[pin.group], pin.k);
}

// Of several pins the first that holds decides.
void GroupSweep::find_held(std::size_t row, const SweepSubstep& substep, SweepWorker& worker) const {
    const Row x = cloth_.x(row);
    worker.held.clear();
    for (const RowPin& pin : cloth_.pins[row]) {
        if (substep.holds[pin.group] == 0) continue;
        const bool known = std::any_of(worker.held.begin(), worker.held.end(),
                                       [&](const HeldParticle& h) { return h.column == pin.column; });
        if (known) continue;
        worker.held.push_back(
            {pin.column, {x[0][pin.column], x[1][pin.column], x[2][pin.column]}, place_of(pin, substep)});
    }
}

RowStretch GroupSweep::stretch(std::size_t row, std::size_t k, const Row& f, SweepWorker& worker) const {
    const std::size_t first = k * contact_columns,
                      count = std::min(contact_columns, cloth_.columns() - first);
    worker.held_columns.clear();
    for (const HeldParticle& held : worker.held) {
        if (held.column >= first && held.column < first + count)
            worker.held_columns.push_back(held.column - static_cast<std::uint32_t>(first));
    }
    const auto column = static_cast<std::ptrdiff_t>(first);
    return {from(cloth_.x(row), column),
            from(cloth_.v(row), column),
            from(f, column),
            cloth_.tables.mass.row(row) + first,
            count,
            worker.held_columns};
}

// The free motion of a stretch, and what it meets on the way.
void GroupSweep::advance_stretch(const RowStretch& part, const double* inverse_mass,
                                 const SolidSubstep& solids, RowContacts& contacts,
                                 RowContactScratch& scratch) {
    const bool meets = may_touch(model_, solids, part, h_, contacts);
    contacts.constraints.clear();
    contacts.touches = 0;
    if (meets) meet_solids(model_, solids, part, h_, contacts, scratch);
    advance_row(part.x, part.v, part.f, inverse_mass, model_.gravity, h_, part.count);
    if (!meets && keeps_clear(solids, part, h_, contacts)) return;
    settle_contacts(model_, solids, part, h_, meets, scratch);
    contacts.clearance = -1;
}

void GroupSweep::advance(std::size_t row, const SweepSubstep& substep, const Row& f, SweepWorker& worker) {
    const Row x = cloth_.x(row), v = cloth_.v(row);
    find_held(row, substep, worker);
    const double* const inverse_mass = cloth_.tables.inverse_mass.row(row);
    if (model_.solids.empty()) advance_row(x, v, f, inverse_mass, model_.gravity, h_, cloth_.columns());
    for (std::size_t k = 0; k < cloth_.stretches; ++k) {
        advance_stretch(stretch(row, k, f, worker), inverse_mass + k * contact_columns, substep.solids,
                        cloth_.contacts[row * cloth_.stretches + k], worker.contact);
    }
    for (const HeldParticle& held : worker.held) {
        const Vec3 speed = (held.target - held.x) / h_;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto axis = static_cast<Eigen::Index>(c);
            v[c][held.column] = speed[axis];
            x[c][held.column] = held.x[axis] + h_ * speed[axis];
        }
    }
}

}  // namespace unravel::sim
