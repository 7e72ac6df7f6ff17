#pragma once

#include <span>
#include <vector>

#include "sim/kernels/sweep_row.hpp"
#include "sim/state.hpp"
#include "sim/sweep/grid_tables.hpp"
#include "sim/sweep/row_contact.hpp"

namespace unravel {

/// A cloth as the explicit sweep has it: row by row, one array per coordinate.

/// Columns beside a row's own that repeat it across a tube's seam; a spring reaches over two.
inline constexpr std::size_t seam_margin = 4;

/// A particle that a pin of the scene moves.
struct RowPin {
    std::uint32_t column, group;
    Vec3 start;
};

/// What a substep needs besides the state.
struct SweepSubstep {
    RowWind wind;
    SolidSubstep solids;
    std::vector<Pose> pins;   ///< (pinned groups) from the start to the substep's end
    std::vector<char> holds;  ///< (pinned groups) not released
};

struct SweptCloth {
    ClothPatch patch;
    GridTables tables;
    std::size_t stride = 0;                 ///< doubles per coordinate of a row
    std::vector<double> state;              ///< row by row: x, y, z, u, v, w
    std::vector<std::vector<RowPin>> pins;  ///< (rows)
    std::vector<RowContacts> contacts;      ///< (stretches); empty without solids
    std::size_t stretches = 0;              ///< per row

    std::size_t columns() const { return static_cast<std::size_t>(patch.particles[0]); }
    std::size_t rows() const { return static_cast<std::size_t>(patch.particles[1]); }
    double* coordinate(std::size_t row, std::size_t c) {
        return state.data() + (row * 6 + c) * stride + seam_margin;
    }
    Row x(std::size_t row) { return {coordinate(row, 0), coordinate(row, 1), coordinate(row, 2)}; }
    Row v(std::size_t row) { return {coordinate(row, 3), coordinate(row, 4), coordinate(row, 5)}; }
    RowState at(std::size_t row) {
        return {{coordinate(row, 0), coordinate(row, 1), coordinate(row, 2)},
                {coordinate(row, 3), coordinate(row, 4), coordinate(row, 5)}};
    }
    /// Columns past the seam are those on its other side.
    void repeat_over_seam(std::size_t row) {
        if (!patch.tube) return;
        for (std::size_t c = 0; c < 6; ++c) {
            double* const y = coordinate(row, c);
            for (std::size_t k = 0; k < seam_margin / 2; ++k) y[columns() + k] = y[k];
        }
    }
};

/// Finds the particles of the cloth that pins move.
void place_pins(const ClothModel& model, SweptCloth& cloth);

/// What each of `count` substeps of h seconds from t needs.
void plan_substeps(const ClothModel& model, double t, double h, int count, std::vector<SweepSubstep>& out);

/// Takes the cloth's share of a state.
void take_state(const ClothState& state, SweptCloth& cloth);

/// Gives it back: x, v and contacts to `next`, what was constrained in the last substep to `constraints`.
void give_state(SweptCloth& cloth, ClothState& next, Constraints& constraints, std::uint32_t& touches);

}  // namespace unravel
