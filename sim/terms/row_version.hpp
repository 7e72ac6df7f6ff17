#pragma once

#include "sim/terms/grid_rows.hpp"
#include "sim/terms/grid_tables.hpp"

namespace unravel::sim {

/// Rows of forces on the way: what begins in a row reaches down by two at most.
inline constexpr std::size_t rows_in_flight = 3;
struct RowRing {
    double* forces = nullptr;  ///< (rows_in_flight × 3 × stride) N
    std::size_t stride = 0;
    std::size_t size() const { return rows_in_flight * 3 * stride; }
    Row row(std::size_t j) const {
        double* const f = forces + j % rows_in_flight * 3 * stride + seam_margin;
        return {f, f + stride, f + 2 * stride};
    }
    void clear(std::size_t j) const {
        std::fill_n(forces + j % rows_in_flight * 3 * stride, 3 * stride, 0.0);
    }
};

/// A cloth whose rows are passed one after the other.
struct RowPass {
    const GridRows& cloth;
    const GridTables& tables;
    const RowWind& wind;
    RowRing forces;
    std::size_t first = 0;  ///< rows above it get nothing: only what reaches it from there is evaluated
};

/// A force along rows: `add` gives the forces of all that begins in a row to both of its ends.
struct RowVersion {
    std::size_t reach;                          ///< rows down to the farther end, at most
    bool (*present)(const GridTables& tables);  ///< whether the cloth has any of it; null: it has
    void (*add)(const RowPass& pass, std::size_t row);
    /// Its springs may be implicit, so that a coupled step splits them along rows itself
    /// (sim/sweep/row_forces.hpp).
    bool splits = false;
};

/// Calls f(k, a, b, count, fa, fb) for family k of those springs that begin in a row: their ends' rows,
/// shifted so that spring i joins column i of both, and the ends' forces.
template <typename F>
void each_family(const RowPass& pass, std::size_t row, const std::array<GridFamily, 4>& families,
                 const F& f) {
    const GridRows& cloth = pass.cloth;
    for (std::size_t k = 0; k < families.size(); ++k) {
        const GridFamily& family = families[k];
        const std::size_t other = row + static_cast<std::size_t>(family.dv);
        if (other >= cloth.rows() || other < pass.first) continue;
        f(k, cloth.at(row).from(family.from_u), cloth.at(other).from(family.to_u),
          family_columns(cloth.patch, family), from(pass.forces.row(row), family.from_u),
          from(pass.forces.row(other), family.to_u));
    }
}

}  // namespace unravel::sim
