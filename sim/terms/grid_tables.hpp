#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/bend.hpp"
#include "sim/forces/curvature.hpp"
#include "sim/model/model.hpp"

namespace unravel::sim {

/// A coefficient of every place on a grid, row by row; rows that equal the one before share its memory, so
/// that the few numbers of an even cloth stay in the first cache.
class RowTable {
public:
    /// From (rows × width) values.
    void build(std::span<const double> values, std::size_t width);
    const double* row(std::size_t j) const { return values_.data() + offset_[j]; }
    std::size_t bytes() const {
        return values_.size() * sizeof(double) + offset_.size() * sizeof(std::size_t);
    }

private:
    std::vector<std::size_t> offset_;  // (rows)
    std::vector<double> values_;
};

/// The springs of a family are those that join (i + from_u, j) with (i + to_u, j + dv), for every base column
/// i and row j of a cloth's grid.
struct GridFamily {
    int from_u, to_u, dv;
};
/// Stretch along u and v, shear along both diagonals.
inline constexpr std::array<GridFamily, 4> extension_families{{{0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}}};

/// Where the particles of a curvature stencil stand from its base, (columns, rows), and their weights.
struct GridStencil {
    std::uint32_t count;
    std::array<std::array<int, 2>, 4> at;
    std::array<double, 4> w;
    int columns, rows;  ///< from the base to the farthest
};
/// Lines along u and v, and the cell's twist.
inline constexpr std::array<GridStencil, 3> curvature_stencils{
    {{3, {{{0, 0}, {1, 0}, {2, 0}, {0, 0}}}, {1, -2, 1, 0}, 2, 0},
     {3, {{{0, 0}, {0, 1}, {0, 2}, {0, 0}}}, {1, -2, 1, 0}, 0, 2},
     {4, {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, {1, -1, 1, -1}, 1, 1}}};

/// A cloth's springs as the explicit sweep reads them: by family, no indices.
struct GridTables {
    struct Extension {
        double rest = 0;  ///< m
        bool any = false;
        RowTable stiffness, damping;
    };
    struct Bend {
        double rest = 0;  ///< m
        bool any = false;
        RowTable arc, slope, crossing;  ///< as bend_row() takes them; 0 where there is no spring
    };
    std::array<Extension, 4> extension;
    std::array<Bend, 4> bend;
    std::array<GridFamily, 4> bend_families{};  ///< over one cell or two (sim/forces/grid_springs.hpp)
    std::array<RowTable, 3> curvature;          ///< c of curvature_stencils [N/m]
    bool curves = false;                        ///< there are any
    RowTable mass, inverse_mass;
};

/// Base columns on a cloth of what reaches over so many.
inline std::size_t base_columns(const ClothPatch& patch, int reach) {
    const int columns = patch.tube ? patch.particles[0] : patch.particles[0] - reach;
    return columns > 0 ? static_cast<std::size_t>(columns) : 0;
}
inline std::size_t family_columns(const ClothPatch& patch, const GridFamily& family) {
    return base_columns(patch, family.from_u > family.to_u ? family.from_u : family.to_u);
}

/// Whether a cloth's springs can be taken family by family: a narrow tube's reach round it.
inline bool is_swept(const ClothPatch& patch) {
    return patch.grid() && !(patch.tube && patch.particles[0] <= 4);
}

/// A cloth's springs in a family's place: (directions of extension_families, and likewise of bend springs).
inline std::array<const SpringRows*, 4> extension_rows(const GridSprings& grid) {
    return {&grid.u, &grid.v, &grid.diagonal, &grid.anti};
}
inline std::array<const SpringRows*, 4> bend_rows(const GridSprings& grid) {
    return {&grid.bend_u, &grid.bend_v, &grid.bend_diagonal, &grid.bend_anti};
}
inline std::array<const SpringRows*, 3> curvature_rows(const GridSprings& grid) {
    return {&grid.curve_u, &grid.curve_v, &grid.twist};
}

/// The tables of one cloth for a step size whose bend limit is `limit`.
void build_tables(const ClothModel& model, const GridSprings& grid, const BendLimit& limit,
                  GridTables& tables);

/// A table over the springs of one family: f(spring), zero where a base column has none.
template <typename F>
void tabulate(const GridSprings& grid, const SpringRows& rows, const F& f, RowTable& table) {
    std::vector<double> values(grid.count(), 0.0);
    for (std::uint32_t j = 0; j < rows.rows; ++j) {
        for (std::uint32_t i = 0; i < rows.per_row; ++i)
            values[static_cast<std::size_t>(j) * grid.nu + i] = f(rows.at(i, j));
    }
    table.build(values, grid.nu);
}

}  // namespace unravel::sim
