#include "sim/sweep/grid_tables.hpp"

#include <algorithm>
#include <cstring>

namespace unravel {

namespace {

// Where a spring is on its cloth's grid: its family, and the row and column of its base.
struct Seat {
    int family = -1;
    std::size_t index = 0;  // base, as row·width + column
};

Seat seat_of(const ClothPatch& patch, std::span<const GridFamily> families, std::uint32_t p,
             std::uint32_t q) {
    const int nu = patch.particles[0];
    const int a = static_cast<int>(p - patch.first), b = static_cast<int>(q - patch.first);
    int row = a / nu, column = a % nu, dv = b / nu - row, du = b % nu - column;
    if (patch.tube && 2 * std::abs(du) > nu) du += du > 0 ? -nu : nu;
    if (dv == 0 && du < 0) {  // p < q, so only over a tube's seam
        column = b % nu;
        du = -du;
    }
    for (int f = 0; f < static_cast<int>(families.size()); ++f) {
        const GridFamily& family = families[static_cast<std::size_t>(f)];
        if (family.dv != dv || family.to_u - family.from_u != du) continue;
        const int base = (column - family.from_u + nu) % nu;
        return {
            f, static_cast<std::size_t>(row) * static_cast<std::size_t>(nu) + static_cast<std::size_t>(base)};
    }
    return {};
}

bool is_of(const ClothPatch& patch, std::uint32_t p) {
    return p >= patch.first && p < patch.first + patch.count();
}

// Fills (springs' seats) of one family with f(spring), zero elsewhere.
class Gathered {
public:
    Gathered(std::size_t count, std::size_t width) : values_(count, 0.0), width_(width) {}
    void set(std::size_t index, double value) { values_[index] = value; }
    void build(RowTable& table) {
        table.build(values_, width_);
        std::fill(values_.begin(), values_.end(), 0.0);
    }

private:
    std::vector<double> values_;
    std::size_t width_;
};

}  // namespace

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

bool build_tables(const ClothModel& model, const ClothPatch& patch, const BendLimit& limit,
                  GridTables& tables) {
    const std::size_t count = patch.count(), width = static_cast<std::size_t>(patch.particles[0]);
    // Which springs sit where; a family at a time, so that a large cloth needs little memory for it.
    std::vector<std::vector<std::pair<std::uint32_t, std::size_t>>> seats(4);
    const auto seat_all = [&](std::span<const GridFamily> families, std::span<const std::uint32_t> i,
                              std::span<const std::uint32_t> j) {
        for (auto& family : seats) family.clear();
        for (std::uint32_t s = 0; s < i.size(); ++s) {
            if (!is_of(patch, i[s])) continue;
            const Seat seat = seat_of(patch, families, i[s], j[s]);
            if (seat.family < 0) return false;
            seats[static_cast<std::size_t>(seat.family)].emplace_back(s, seat.index);
        }
        return true;
    };
    Gathered a(count, width), b(count, width), c(count, width);
    const auto same_rest = [](const std::vector<double>& rest, const auto& family, double& out) {
        if (!family.empty()) out = rest[family.front().first];
        return std::all_of(family.begin(), family.end(),
                           [&](const auto& seat) { return rest[seat.first] == out; });
    };

    if (!seat_all(extension_families, model.springs.i, model.springs.j)) return false;
    for (std::size_t f = 0; f < 4; ++f) {
        GridTables::Extension& out = tables.extension[f];
        if (!same_rest(model.springs.rest, seats[f], out.rest)) return false;
        for (const auto& [spring, index] : seats[f]) {
            a.set(index, model.springs.stiffness[spring]);
            b.set(index, model.springs.damping[spring]);
        }
        a.build(out.stiffness);
        b.build(out.damping);
    }
    if (!seat_all(bend_families, model.bends.i, model.bends.j)) return false;
    for (std::size_t f = 0; f < 4; ++f) {
        GridTables::Bend& out = tables.bend[f];
        if (!same_rest(model.bends.rest, seats[f], out.rest)) return false;
        out.any = !seats[f].empty();
        for (const auto& [spring, index] : seats[f]) {
            a.set(index, 4.0 * model.bends.stiffness[spring] / (out.rest * out.rest));
            b.set(index, limit.slope[spring]);
            c.set(index, limit.crossing[spring]);
        }
        a.build(out.arc);
        b.build(out.slope);
        c.build(out.crossing);
    }
    // One more column: the cell over a tube's seam has corners on both of its sides.
    Gathered mass(count + count / width, width + 1);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t row = k / width, column = k % width, first = row * (width + 1);
        mass.set(first + column, model.mass[patch.first + k]);
        if (column == 0) mass.set(first + width, model.mass[patch.first + k]);
        a.set(k, 1.0 / model.mass[patch.first + k]);
    }
    mass.build(tables.mass);
    a.build(tables.inverse_mass);
    return true;
}

}  // namespace unravel
