#include "sim/sweep/row_forces.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace unravel::sim {

// Rows of a band: what a band evaluates once more, two rows at most, should be little of it.
constexpr std::size_t band_rows = 16;
struct RowCloth : GridRows {
    using GridRows::GridRows;
    const GridSprings* grid = nullptr;
    GridTables tables;
    std::array<RowTable, 4> is_explicit;  // as extension_families
    std::vector<double> pushed;           // row by row: x, y, z of explicit forces
    bool pushes = false;                  // there are any

    std::size_t bands() const { return (rows() + band_rows - 1) / band_rows; }
    Row pushed_row(std::size_t row) {
        double* const f = pushed.data() + row * 3 * stride + seam_margin;
        return {f, f + stride, f + 2 * stride};
    }
};

// The forces of the rows in flight.
struct Flight {
    std::vector<double> forces;
    RowRing start(std::size_t stride) {
        forces.assign(rows_in_flight * 3 * stride, 0.0);
        return {forces.data(), stride};
    }
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
    ForceSettings settings;
    std::vector<RowCloth> cloths;
    tbb::enumerable_thread_specific<Flight> flights;

    // Calls base(pass, row) for the rows from which something reaches the band that begins with row
    // `pass.first`, and done(row, forces) for its own once all has arrived.
    template <typename Base, typename Done>
    void over_bands(RowCloth& cloth, const RowWind& wind, std::size_t reach, const Base& base,
                    const Done& done) {
        tbb::parallel_for(std::size_t{0}, cloth.bands(), [&](std::size_t band) {
            const std::size_t first = band * band_rows, last = std::min(first + band_rows, cloth.rows());
            const RowPass pass{cloth, cloth.tables, wind, flights.local().start(cloth.stride), first};
            for (std::size_t row = first - std::min(first, reach); row < last; ++row) {
                base(pass, row);
                if (row >= first) {
                    fold_over_seam(cloth, pass.forces.row(row));
                    done(row, pass.forces.row(row));
                }
                pass.forces.clear(row);
            }
        });
    }
};

std::string why_not_by_rows(const ClothModel& model) {
    std::size_t covered = 0;
    for (const ClothPatch& patch : model.cloths) {
        if (!patch.grid()) return fmt::format("cloth {} is a mesh", patch.name);
        if (!is_swept(patch))
            return fmt::format("the tube {} is too narrow for springs that reach over two columns",
                               patch.name);
        covered += patch.count();
    }
    return covered == model.size() ? "" : "some particles belong to no cloth";
}

RowWind row_wind(const ClothModel& model, double t, double h) {
    if (!model.wind) return {};
    return {wind_velocity(*model.wind, t), model.wind->density, model.wind->drag, model.wind->lift, h};
}

RowForces::RowForces() : memory_(std::make_unique<RowForcesMemory>()) {}
RowForces::~RowForces() = default;
RowForces::RowForces(RowForces&&) noexcept = default;
RowForces& RowForces::operator=(RowForces&&) noexcept = default;

void RowForces::prepare(const ClothModel& model, const ForceMemory& forces, const ForceSettings& settings) {
    RowForcesMemory& memory = *memory_;
    memory.settings.band = settings.band;  // no table depends on it
    if (memory.model == model.mass.data() && memory.particles == model.size() && memory.settings == settings)
        return;
    memory.model = model.mass.data();
    memory.particles = model.size();
    memory.settings = settings;
    memory.cloths.clear();
    for (std::size_t k = 0; k < model.cloths.size(); ++k) {
        RowCloth& cloth = memory.cloths.emplace_back(model.cloths[k]);
        cloth.grid = &model.grids[k];
        build_tables(model, *cloth.grid, forces.bending.limit, cloth.tables);
        const auto rows = extension_rows(*cloth.grid);
        const ExtensionSprings& springs = model.springs;
        const auto bears = [&](std::uint32_t s) {
            const double of_spring =
                kappa_between(settings.h, model.mass[springs.i[s]], model.mass[springs.j[s]],
                              springs.stiffness[s], springs.damping[s]);
            return is_explicit(of_spring, settings.splitting.threshold(s < springs.stretch_count)) ? 1.0
                                                                                                   : 0.0;
        };
        for (std::size_t f = 0; f < rows.size(); ++f)
            tabulate(*cloth.grid, *rows[f], bears, cloth.is_explicit[f]);
    }
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
        for (const RowTable& t : cloth.tables.curvature) sum += t.bytes();
        for (const RowTable& t : cloth.is_explicit) sum += t.bytes();
    }
    return sum;
}

void RowForces::place(std::span<const Vec3> x, std::span<const Vec3> v) {
    for (RowCloth& cloth : memory_->cloths) load_rows(x, v, cloth);
}

void RowForces::mark(const ClothModel& model, std::span<const Vec3> end, std::vector<std::uint8_t>& taut) {
    taut.resize(model.springs.size());
    for (RowCloth& cloth : memory_->cloths) {
        tbb::parallel_for(std::size_t{0}, cloth.bands(), [&](std::size_t band) {
            // Two rows of end positions, turned as they are reached.
            const RowRing rows = memory_->flights.local().start(cloth.stride);
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

void RowForces::begin() {
    for (RowCloth& cloth : memory_->cloths) cloth.pushes = false;
}

void RowForces::push(const ClothModel& model, const RowVersion& term, double t) {
    const RowWind wind = row_wind(model, t, memory_->settings.all_explicit ? memory_->settings.h : 0.0);
    for (RowCloth& cloth : memory_->cloths) {
        if (term.present && !term.present(cloth.tables)) continue;
        cloth.pushed.resize(cloth.rows() * 3 * cloth.stride);
        const bool first = !cloth.pushes;
        const auto done = [&](std::size_t row, const Row& f) {
            const Row to = cloth.pushed_row(row);
            for (std::size_t c = 0; c < 3; ++c) {
                if (first) std::copy_n(f[c], cloth.columns(), to[c]);
                for (std::size_t i = 0; !first && i < cloth.columns(); ++i) to[c][i] += f[c][i];
            }
        };
        memory_->over_bands(cloth, wind, term.reach, term.add, done);
        cloth.pushes = true;
    }
}

void RowForces::gather(const ClothModel& model, std::span<const std::uint8_t> taut, std::span<Vec3> force,
                       std::vector<SpringState>& state) {
    state.resize(model.springs.size());
    const double band = memory_->settings.band;
    for (RowCloth& cloth : memory_->cloths) {
        const auto springs = extension_rows(*cloth.grid);
        const auto base = [&](const RowPass& pass, std::size_t row) {
            each_family(pass, row, extension_families,
                        [&](std::size_t k, const RowState& a, const RowState& b, std::size_t count,
                            const Row& fa, const Row& fb) {
                            const GridTables::Extension& table = cloth.tables.extension[k];
                            if (!table.any) return;
                            const std::uint32_t at = springs[k]->at(0, static_cast<std::uint32_t>(row));
                            split_row(a, b, table.rest, table.stiffness.row(row), table.damping.row(row),
                                      cloth.is_explicit[k].row(row),
                                      taut.empty() ? nullptr : taut.data() + at, (1.0 - band) * table.rest,
                                      count, fa, fb, row >= pass.first ? state.data() + at : nullptr);
                        });
        };
        const auto done = [&](std::size_t row, const Row& f) {
            if (cloth.pushes) {
                const Row pushed = cloth.pushed_row(row);
                for (std::size_t c = 0; c < 3; ++c) {
                    for (std::size_t i = 0; i < cloth.columns(); ++i) f[c][i] += pushed[c][i];
                }
            }
            Vec3* const to = force.data() + cloth.patch.first + row * cloth.columns();
            const double* const mass = cloth.tables.mass.row(row);
            for (std::size_t i = 0; i < cloth.columns(); ++i)
                to[i] = mass[i] * model.gravity + Vec3(f[0][i], f[1][i], f[2][i]);
        };
        memory_->over_bands(cloth, {}, 1, base, done);
    }
}

}  // namespace unravel::sim
