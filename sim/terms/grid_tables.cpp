#include "sim/terms/grid_tables.hpp"

#include <algorithm>

namespace unravel::sim {

void RowTable::build(std::span<const double> values, std::size_t width) {
    offset_.clear();
    values_.clear();
    for (std::size_t first = 0; first < values.size(); first += width) {
        const std::span<const double> row = values.subspan(first, width);
        const bool same =
            first > 0 &&
            std::equal(row.begin(), row.end(), values.begin() + static_cast<std::ptrdiff_t>(first - width));
        if (!same) values_.insert(values_.end(), row.begin(), row.end());
        offset_.push_back(values_.size() - width);
    }
    values_.shrink_to_fit();
}

void build_tables(const ClothModel& model, const GridSprings& grid, const BendLimit& limit,
                  GridTables& tables) {
    const auto of = [](const Coefficients& values) {
        return [&values](std::uint32_t s) { return values[s]; };
    };
    const auto extension = extension_rows(grid);
    for (std::size_t f = 0; f < 4; ++f) {
        const SpringRows& rows = *extension[f];
        GridTables::Extension& out = tables.extension[f];
        out.any = rows.count() > 0;
        if (!out.any) continue;
        out.rest = model.springs.rest[rows.first];
        tabulate(grid, rows, of(model.springs.stiffness), out.stiffness);
        tabulate(grid, rows, of(model.springs.damping), out.damping);
    }
    const auto bend = bend_rows(grid);
    for (std::size_t f = 0; f < 4; ++f) {
        const SpringRows& rows = *bend[f];
        GridTables::Bend& out = tables.bend[f];
        out.any = rows.count() > 0;
        if (!out.any) continue;
        out.rest = model.bends.rest[rows.first];
        tables.bend_families[f] = {static_cast<int>(rows.from[0]), static_cast<int>(rows.to[0]),
                                   static_cast<int>(rows.to[1])};
        const double scale = 4.0 / (out.rest * out.rest);
        tabulate(
            grid, rows, [&](std::uint32_t s) { return scale * model.bends.stiffness[s]; }, out.arc);
        tabulate(grid, rows, of(limit.slope), out.slope);
        tabulate(grid, rows, of(limit.crossing), out.crossing);
    }
    const auto curvature = curvature_rows(grid);
    for (std::size_t f = 0; f < curvature.size(); ++f) {
        tables.curves = tables.curves || curvature[f]->count() > 0;
        tabulate(grid, *curvature[f], of(model.curvature.stiffness), tables.curvature[f]);
    }
    // One more column: the cell over a tube's seam has corners on both of its sides.
    const std::size_t width = grid.nu;
    std::vector<double> mass(static_cast<std::size_t>(grid.nv) * (width + 1)), inverse(grid.count());
    for (std::size_t k = 0; k < grid.count(); ++k) {
        const double m = model.mass[grid.particle + k];
        mass[k / width * (width + 1) + k % width] = m;
        if (k % width == 0) mass[k / width * (width + 1) + width] = m;
        inverse[k] = 1.0 / m;
    }
    tables.mass.build(mass, width + 1);
    tables.inverse_mass.build(inverse, width);
}

}  // namespace unravel::sim
