#pragma once

#include <span>
#include <vector>

#include "sim/constraints/pins.hpp"
#include "sim/model/state.hpp"
#include "sim/sweep/row_contact.hpp"
#include "sim/terms/row_version.hpp"

namespace unravel::sim {

/// A cloth as the explicit sweep has it: row by row, one array per coordinate.

/// A particle that a pin of the scene moves.
struct RowPin {
    std::uint32_t column, group;
    std::uint32_t k;  ///< which of the group's particles it is
    Vec3 start;
};

/// What a substep needs besides the state.
struct SweepSubstep {
    RowWind wind;
    SolidSubstep solids;
    std::vector<Pose> pins;          ///< (pinned groups) from the start to the substep's end
    std::vector<PinMoment> moments;  ///< (pinned groups) of those that move not as one body; empty: all do
    std::vector<char> holds;         ///< (pinned groups) not released
};

struct SweptCloth : GridRows {
    using GridRows::GridRows;
    GridTables tables;
    std::vector<const RowVersion*> terms;   ///< forces that act on it, in the order of the list
    std::vector<std::vector<RowPin>> pins;  ///< (rows)
    std::vector<RowContacts> contacts;      ///< (stretches); empty without solids
    std::size_t stretches = 0;              ///< per row
};

/// Finds the particles of the cloth that pins move.
void place_pins(const ClothModel& model, SweptCloth& cloth);

/// What each of `count` substeps of h seconds from t needs.
void plan_substeps(const ClothModel& model, double t, double h, int count, std::vector<SweepSubstep>& out);

/// Takes the cloth's share of a state.
void take_state(const ClothState& state, SweptCloth& cloth);

/// Gives it back: x, v and contacts to `next`, what was constrained in the last substep to `constraints`.
void give_state(SweptCloth& cloth, ClothState& next, Constraints& constraints, std::uint32_t& touches);

}  // namespace unravel::sim
