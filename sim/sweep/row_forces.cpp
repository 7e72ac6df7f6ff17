#include "sim/sweep/row_forces.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "sim/forces/air.hpp"
#include "sim/sweep/grid_tables.hpp"

namespace unravel::sim {

// Rows of a band: what a band evaluates once more, two rows at most, should be little of it.
constexpr std::size_t band_rows = 16;
// Rows in flight: a spring reaches from its own to the next but one.
constexpr std::size_t flight = 3;

struct RowCloth : GridRows {
    using GridRows::GridRows;
    const GridSprings* grid = nullptr;
    GridTables tables;
    std::array<RowTable, 4> is_explicit;  // as extension_families
    bool bends = false;                   // it has bend springs
    std::vector<double> pushed;           // row by row: x, y, z of bending and air; empty: neither

    std::size_t bands() const { return (rows() + band_rows - 1) / band_rows; }
    Row pushed_row(std::size_t row) {
        double* const f = pushed.data() + row * 3 * stride + seam_margin;
        return {f, f + stride, f + 2 * stride};
    }
};

// The forces of the rows in flight.
struct Flight {
    std::vector<double> forces;
    std::size_t stride = 0;
    void start(std::size_t of) {
        stride = of;
        forces.assign(flight * 3 * stride, 0.0);
    }
    Row row(std::size_t j) {
        double* const f = forces.data() + j % flight * 3 * stride + seam_margin;
        return {f, f + stride, f + 2 * stride};
    }
    void clear(std::size_t j) { std::fill_n(forces.data() + j % flight * 3 * stride, 3 * stride, 0.0); }
};

namespace {

// What columns past a tube's seam got is their originals'.
void fold_over_seam(const RowCloth& cloth, const Row& f) {
    if (!cloth.patch.tube) return;
    for (double* const y : f) {
        for (std::size_t k = 0; k < seam_margin / 2; ++k) y[k] += y[cloth.columns() + k];
    }
}

}  // namespace

struct RowForcesMemory {
    const double* model = nullptr;  // the masses that the tables were made of
    std::size_t particles = 0;
    double limit_h = 0;
    RowSplitting splitting;
    bool fits = false;
    std::vector<RowCloth> cloths;
    tbb::enumerable_thread_specific<Flight> flights;

    // Calls base(row, first, flight) for the rows from which something reaches the band, `first` being the
    // band's first row, and done(row, forces) for its own once all has arrived.
    template <typename Base, typename Done>
    void over_bands(RowCloth& cloth, std::size_t reach, const Base& base, const Done& done) {
        tbb::parallel_for(std::size_t{0}, cloth.bands(), [&](std::size_t band) {
            Flight& forces = flights.local();
            forces.start(cloth.stride);
            const std::size_t first = band * band_rows, last = std::min(first + band_rows, cloth.rows());
            for (std::size_t row = first - std::min(first, reach); row < last; ++row) {
                base(row, first, forces);
                if (row >= first) {
                    fold_over_seam(cloth, forces.row(row));
                    done(row, forces.row(row));
                }
                forces.clear(row);
            }
        });
    }
};

RowForces::RowForces() : memory_(std::make_unique<RowForcesMemory>()) {}
RowForces::~RowForces() = default;
RowForces::RowForces(RowForces&&) noexcept = default;
RowForces& RowForces::operator=(RowForces&&) noexcept = default;

bool RowForces::prepare(const ClothModel& model, const BendLimit& limit, const RowSplitting& splitting) {
    RowForcesMemory& memory = *memory_;
    if (memory.model == model.mass.data() && memory.particles == model.size() && memory.limit_h == limit.h &&
        memory.splitting == splitting)
        return memory.fits;
    memory.model = model.mass.data();
    memory.particles = model.size();
    memory.limit_h = limit.h;
    memory.splitting = splitting;
    memory.cloths.clear();
    memory.fits = std::all_of(model.cloths.begin(), model.cloths.end(), is_swept);
    std::size_t covered = 0;
    for (const ClothPatch& patch : model.cloths) covered += patch.count();
    memory.fits = memory.fits && covered == model.size();  // a model may hold particles of no cloth
    for (std::size_t k = 0; memory.fits && k < model.cloths.size(); ++k) {
        RowCloth& cloth = memory.cloths.emplace_back(model.cloths[k]);
        cloth.grid = &model.grids[k];
        build_tables(model, *cloth.grid, limit, cloth.tables);
        const auto rows = extension_rows(*cloth.grid);
        for (std::size_t f = 0; f < rows.size(); ++f) {
            const ExtensionSprings& springs = model.springs;
            const auto bears = [&](std::uint32_t s) {
                const double lighter = std::min(model.mass[springs.i[s]], model.mass[springs.j[s]]);
                const double threshold = s < springs.stretch_count ? splitting.splitting.stretch_threshold
                                                                   : splitting.splitting.shear_threshold;
                return kappa(splitting.h, 1.0 / lighter, springs.stiffness[s], springs.damping[s]) <=
                               threshold
                           ? 1.0
                           : 0.0;
            };
            tabulate(*cloth.grid, *rows[f], bears, cloth.is_explicit[f]);
        }
        cloth.bends = std::any_of(cloth.tables.bend.begin(), cloth.tables.bend.end(),
                                  [](const GridTables::Bend& b) { return b.any; });
        if (cloth.bends || model.wind) cloth.pushed.assign(cloth.rows() * 3 * cloth.stride, 0.0);
    }
    return memory.fits;
}

std::size_t RowForces::bytes() const {
    std::size_t sum = 0;
    for (const RowCloth& cloth : memory_->cloths) {
        sum += (cloth.state.size() + cloth.pushed.size()) * sizeof(double);
        sum += cloth.tables.mass.bytes() + cloth.tables.inverse_mass.bytes();
        for (const GridTables::Extension& t : cloth.tables.extension)
            sum += t.stiffness.bytes() + t.damping.bytes();
        for (const GridTables::Bend& t : cloth.tables.bend)
            sum += t.arc.bytes() + t.slope.bytes() + t.crossing.bytes();
        for (const RowTable& t : cloth.is_explicit) sum += t.bytes();
    }
    return sum;
}

void RowForces::place(std::span<const Vec3> x, std::span<const Vec3> v) {
    for (RowCloth& cloth : memory_->cloths) take_rows(x, v, cloth);
}

void RowForces::mark(const ClothModel& model, std::span<const Vec3> end, std::vector<std::uint8_t>& taut) {
    taut.resize(model.springs.size());
    for (RowCloth& cloth : memory_->cloths) {
        tbb::parallel_for(std::size_t{0}, cloth.bands(), [&](std::size_t band) {
            // Two rows of end positions, turned as they are reached.
            Flight& rows = memory_->flights.local();
            rows.start(cloth.stride);
            const std::size_t first = band * band_rows, last = std::min(first + band_rows, cloth.rows());
            const auto turn = [&](std::size_t row) {
                const Row to = rows.row(row);
                const Vec3* const from = end.data() + cloth.patch.first + row * cloth.columns();
                for (std::size_t i = 0; i < cloth.columns(); ++i) {
                    for (std::size_t c = 0; c < 3; ++c) to[c][i] = from[i][static_cast<Eigen::Index>(c)];
                }
                for (std::size_t k = 0; cloth.patch.tube && k < seam_margin / 2; ++k) {
                    for (double* const y : to) y[cloth.columns() + k] = y[k];
                }
            };
            turn(first);
            const auto springs = extension_rows(*cloth.grid);
            for (std::size_t row = first; row < last; ++row) {
                if (row + 1 < cloth.rows()) turn(row + 1);
                for (std::size_t f = 0; f < springs.size(); ++f) {
                    const GridFamily& family = extension_families[f];
                    if (row >= springs[f]->rows) continue;
                    const Row a = from(rows.row(row), family.from_u),
                              b = from(rows.row(row + static_cast<std::size_t>(family.dv)), family.to_u);
                    mark_row({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, cloth.tables.extension[f].rest,
                             springs[f]->per_row,
                             taut.data() + springs[f]->at(0, static_cast<std::uint32_t>(row)));
                }
            }
        });
    }
}

void RowForces::bend(bool acts) {
    for (RowCloth& cloth : memory_->cloths) {
        if (!acts || !cloth.bends) {
            std::fill(cloth.pushed.begin(), cloth.pushed.end(), 0.0);
            continue;
        }
        const auto base = [&](std::size_t row, std::size_t first, Flight& forces) {
            for (std::size_t f = 0; f < bend_families.size(); ++f) {
                const GridFamily& family = bend_families[f];
                const std::size_t other = row + static_cast<std::size_t>(family.dv);
                const GridTables::Bend& table = cloth.tables.bend[f];
                if (!table.any || other >= cloth.rows() || other < first) continue;
                bend_row(cloth.at(row).from(family.from_u), cloth.at(other).from(family.to_u), table.rest,
                         table.arc.row(row), table.slope.row(row), table.crossing.row(row),
                         family_columns(cloth.patch, family), from(forces.row(row), family.from_u),
                         from(forces.row(other), family.to_u));
            }
        };
        const auto done = [&](std::size_t row, const Row& f) {
            const Row to = cloth.pushed_row(row);
            for (std::size_t c = 0; c < 3; ++c) std::copy_n(f[c], cloth.columns(), to[c]);
        };
        memory_->over_bands(cloth, 2, base, done);
    }
}

void RowForces::blow(const ClothModel& model, double t) {
    const RowWind wind{wind_velocity(*model.wind, t), model.wind->density, model.wind->drag, model.wind->lift,
                       memory_->splitting.h};
    for (RowCloth& cloth : memory_->cloths) {
        const auto base = [&](std::size_t row, std::size_t, Flight& forces) {
            if (row + 1 >= cloth.rows()) return;
            air_row(cloth.at(row), cloth.at(row + 1), cloth.tables.mass.row(row),
                    cloth.tables.mass.row(row + 1), wind, static_cast<std::size_t>(cloth.patch.cells_u()),
                    forces.row(row), forces.row(row + 1));
        };
        const auto done = [&](std::size_t row, const Row& f) {
            const Row to = cloth.pushed_row(row);
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t i = 0; i < cloth.columns(); ++i) to[c][i] += f[c][i];
            }
        };
        memory_->over_bands(cloth, 1, base, done);
    }
}

void RowForces::gather(const ClothModel& model, std::span<const std::uint8_t> taut, std::span<Vec3> force,
                       std::vector<SpringState>& state) {
    state.resize(model.springs.size());
    const double band = memory_->splitting.band;
    for (RowCloth& cloth : memory_->cloths) {
        const auto springs = extension_rows(*cloth.grid);
        const auto base = [&](std::size_t row, std::size_t first, Flight& forces) {
            for (std::size_t f = 0; f < springs.size(); ++f) {
                const GridFamily& family = extension_families[f];
                const std::size_t other = row + static_cast<std::size_t>(family.dv);
                if (row >= springs[f]->rows || other < first) continue;
                const GridTables::Extension& table = cloth.tables.extension[f];
                const std::uint32_t at = springs[f]->at(0, static_cast<std::uint32_t>(row));
                split_row(cloth.at(row).from(family.from_u), cloth.at(other).from(family.to_u), table.rest,
                          table.stiffness.row(row), table.damping.row(row), cloth.is_explicit[f].row(row),
                          taut.empty() ? nullptr : taut.data() + at, (1.0 - band) * table.rest,
                          springs[f]->per_row, from(forces.row(row), family.from_u),
                          from(forces.row(other), family.to_u), row >= first ? state.data() + at : nullptr);
            }
        };
        const auto done = [&](std::size_t row, const Row& f) {
            if (!cloth.pushed.empty()) {
                const Row pushed = cloth.pushed_row(row);
                for (std::size_t c = 0; c < 3; ++c) {
                    for (std::size_t i = 0; i < cloth.columns(); ++i) f[c][i] += pushed[c][i];
                }
            }
            Vec3* const to = force.data() + cloth.patch.first + row * cloth.columns();
            for (std::size_t i = 0; i < cloth.columns(); ++i) to[i] = {f[0][i], f[1][i], f[2][i]};
        };
        memory_->over_bands(cloth, 1, base, done);
    }
}

}  // namespace unravel::sim
