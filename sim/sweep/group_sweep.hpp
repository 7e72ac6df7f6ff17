#pragma once

#include <atomic>

#include "sim/sweep/swept_cloth.hpp"

namespace unravel::sim {

/// Rows by which a substep follows the one before it.
inline constexpr std::size_t sweep_lag = 2;

/// A pinned particle of the row that is moving: where it is, and where it is to be.
struct HeldParticle {
    std::uint32_t column;
    Vec3 x, target;
};

/// Working memory of one thread: forces on the way, three rows for each substep in flight.
struct SweepWorker {
    std::vector<double> forces;
    std::vector<HeldParticle> held;
    std::vector<std::uint32_t> held_columns;
    RowContactScratch contact;
};

/// Takes groups of `levels` substeps of h seconds through a cloth (sim/sweep/explicit_sweep.hpp).
class GroupSweep {
public:
    GroupSweep(const ClothModel& model, SweptCloth& cloth, std::span<const SweepSubstep> substeps, double h,
               std::size_t levels)
        : model_(model), cloth_(cloth), substeps_(substeps), h_(h), levels_(levels) {}

    std::size_t groups() const { return (substeps_.size() + levels_ - 1) / levels_; }

    /// Takes the substeps of one group through the cloth, behind the group before it: `passed` counts, group
    /// by group, the rows that its last substep has moved; null where groups take turns.
    void run(std::size_t group, std::atomic<std::size_t>* passed, SweepWorker& worker);

private:
    void move(std::size_t row, const SweepSubstep& substep, std::size_t level, SweepWorker& worker);
    Vec3 place_of(const RowPin& pin, const SweepSubstep& substep) const;
    void find_held(std::size_t row, const SweepSubstep& substep, SweepWorker& worker) const;
    RowStretch stretch(std::size_t row, std::size_t k, const Row& f, SweepWorker& worker) const;
    void advance_stretch(const RowStretch& part, const double* inverse_mass, const SolidSubstep& solids,
                         RowContacts& contacts, RowContactScratch& scratch);
    void advance(std::size_t row, const SweepSubstep& substep, const Row& f, SweepWorker& worker);

    const ClothModel& model_;
    SweptCloth& cloth_;
    std::span<const SweepSubstep> substeps_;
    double h_;
    std::size_t levels_;
};

}  // namespace unravel::sim
