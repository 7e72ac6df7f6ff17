#pragma once

#include <span>
#include <vector>

#include "sim/model/model.hpp"
#include "sim/rows/sweep_row.hpp"

namespace unravel::sim {

/// Columns beside a row's own that repeat it across a tube's seam; a spring reaches over two.
inline constexpr std::size_t seam_margin = 4;

/// Positions and velocities of a grid cloth row by row, one array per coordinate, for kernels that work along
/// rows (sim/rows/sweep_row.hpp).
struct GridRows {
    ClothPatch patch;
    std::size_t stride = 0;     ///< doubles per coordinate of a row
    std::vector<double> state;  ///< row by row: x, y, z, u, v, w

    explicit GridRows(ClothPatch cloth)
        : patch(std::move(cloth)), stride((columns() + 2 * seam_margin + 7) / 8 * 8) {}
    std::size_t columns() const { return static_cast<std::size_t>(patch.particles[0]); }
    std::size_t rows() const { return static_cast<std::size_t>(patch.particles[1]); }
    double* coordinate(std::size_t row, std::size_t c) {
        return state.data() + (row * 6 + c) * stride + seam_margin;
    }
    const double* coordinate(std::size_t row, std::size_t c) const {
        return state.data() + (row * 6 + c) * stride + seam_margin;
    }
    Row x(std::size_t row) { return {coordinate(row, 0), coordinate(row, 1), coordinate(row, 2)}; }
    Row v(std::size_t row) { return {coordinate(row, 3), coordinate(row, 4), coordinate(row, 5)}; }
    RowState at(std::size_t row) const {
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

/// Fills the rows with the cloth's share of x and v, (particles).
void load_rows(std::span<const Vec3> x, std::span<const Vec3> v, GridRows& cloth);

}  // namespace unravel::sim
