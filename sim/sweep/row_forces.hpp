#pragma once

#include <memory>
#include <span>

#include "sim/forces/extension.hpp"
#include "sim/integrators/scheme.hpp"
#include "sim/model/model.hpp"
#include "sim/sweep/grid_rows.hpp"

namespace unravel::sim {

/// Forces of a step, gathered by particle, where every cloth is a grid: the same as extension_forces(),
/// bend_forces() and air_forces() give spring by spring and cell by cell, evaluated along rows with no index
/// and no memory for each spring but its state. A band of rows is one task; it evaluates once more what
/// reaches into it from the rows above, so that a row's sum runs in the same order however many bands there
/// are.

/// What depends on how the springs are split.
struct RowSplitting {
    double h = 0;  ///< s, of the step
    Splitting splitting;
    double band = 0;  ///< see extension_forces()
    friend bool operator==(const RowSplitting& a, const RowSplitting& b) {
        return a.h == b.h && a.band == b.band &&
               a.splitting.stretch_threshold == b.splitting.stretch_threshold &&
               a.splitting.shear_threshold == b.splitting.shear_threshold;
    }
};

struct RowForcesMemory;

class RowForces {
public:
    RowForces();
    ~RowForces();
    RowForces(RowForces&&) noexcept;
    RowForces& operator=(RowForces&&) noexcept;

    /// Makes ready for steps of a model; does nothing where it is so already. False where the model has cloth
    /// that is no grid, or a tube too narrow for its springs.
    bool prepare(const ClothModel& model, const BendLimit& limit, const RowSplitting& splitting);

    /// Takes positions and velocities, (particles), at which forces are evaluated from now on.
    void place(std::span<const Vec3> x, std::span<const Vec3> v);

    /// Marks stretch and shear springs that are longer than L at `end`, (particles) [m]; `taut` (springs).
    void mark(const ClothModel& model, std::span<const Vec3> end, std::vector<std::uint8_t>& taut);

    /// Begins with what gather() is to give besides stretch and shear: bending, if it `acts`, or nothing.
    void bend(bool acts);
    /// The air at time t; after bend().
    void blow(const ClothModel& model, double t);

    /// Adds stretch and shear: force (particles) [N], and the springs' states. `taut` (springs) or empty.
    void gather(const ClothModel& model, std::span<const std::uint8_t> taut, std::span<Vec3> force,
                std::vector<SpringState>& state);

    /// Of what it keeps for the cloth, tables included.
    std::size_t bytes() const;

private:
    std::unique_ptr<RowForcesMemory> memory_;
};

}  // namespace unravel::sim
