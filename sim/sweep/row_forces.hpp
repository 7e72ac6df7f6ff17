#pragma once

#include <memory>
#include <span>
#include <string>

#include "sim/terms/row_version.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

/// Forces of a step, gathered by particle, where every cloth is a grid: the same as the terms give spring by
/// spring and cell by cell, evaluated along rows with no index and no memory for each spring but its state. A
/// band of rows is one task; it evaluates once more what reaches into it from the rows above, so that a row's
/// sum runs in the same order however many bands there are.

/// Why the model's cloths can't be taken row by row: one is a mesh, or a tube too narrow for its springs, or
/// there are particles of no cloth. Empty: they can.
std::string why_not_by_rows(const ClothModel& model);

struct RowForcesMemory;

class RowForces {
public:
    RowForces();
    ~RowForces();
    RowForces(RowForces&&) noexcept;
    RowForces& operator=(RowForces&&) noexcept;

    /// Makes ready for steps of a model that goes by rows; does nothing where it is so already. `forces` is
    /// as prepare_terms() left it for the settings' h.
    void prepare(const ClothModel& model, const ForceMemory& forces, const ForceSettings& settings);

    /// Takes positions and velocities, (particles), at which forces are evaluated from now on.
    void place(std::span<const Vec3> x, std::span<const Vec3> v);

    /// Marks stretch and shear springs that are longer than L at `end`, (particles) [m]; `taut` (springs).
    void mark(const ClothModel& model, std::span<const Vec3> end, std::vector<std::uint8_t>& taut);

    /// Forgets what gather() is to give besides springs and gravity.
    void begin();
    /// Adds a force that is explicit to that, as it is at time t.
    void push(const ClothModel& model, const RowVersion& term, double t);

    /// What was pushed, stretch and shear springs, and gravity: force (particles) [N], and the springs'
    /// states. `taut` (springs) or empty.
    void gather(const ClothModel& model, std::span<const std::uint8_t> taut, std::span<Vec3> force,
                std::vector<SpringState>& state);

    /// Of what it keeps for the cloth, tables included.
    std::size_t bytes() const;

private:
    std::unique_ptr<RowForcesMemory> memory_;
};

/// The wind along rows, at time t, for steps of h seconds that take its force for constant; 0: that don't.
RowWind row_wind(const ClothModel& model, double t, double h);

}  // namespace unravel::sim
