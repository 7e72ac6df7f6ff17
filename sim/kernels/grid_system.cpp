#include "sim/kernels/grid_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/forces/curvature.hpp"
#include "sim/rows/couple_row.hpp"

namespace unravel::sim {

namespace {

// Orthonormal columns that span the range of a projection of rank 1 or 2; the second may be zero.
void free_directions(const Mat3& S, double* out) {
    Mat3 rest = S;
    for (int k = 0; k < 2; ++k) {
        Eigen::Index column;
        const double length = rest.colwise().norm().maxCoeff(&column);
        const Vec3 t = length > 0.5 ? Vec3(rest.col(column) / length) : Vec3(Vec3::Zero());
        std::copy_n(t.data(), 3, out + 3 * k);
        rest -= t * t.transpose() * rest;
    }
}

// Where things stand while a component is loaded.
struct Loader {
    const GridSprings& springs;
    const SpringFamily& family;
    const Load& load;
    const Components& components;
    const Constraints& constraints;
    std::span<const Vec3> guess;
    double h;
    const GridBending& bending;
    GridSystem& out;
    int nu, pitch;
    std::int32_t label;
    int first_row;  ///< of the cloth, that is row 0 here

    bool ours(std::uint32_t p) const { return components.label[p] == label; }
    std::ptrdiff_t at(int i, int j, int numbers) const {
        return static_cast<std::ptrdiff_t>(j) * numbers * pitch + StencilGrid::margin + i;
    }
};

constexpr std::array<const SpringRows GridSprings::*, 4> families{&GridSprings::u, &GridSprings::v,
                                                                  &GridSprings::diagonal, &GridSprings::anti};

// The arcs that lie along a family's springs; or null.
const SpringRows* arcs_along(const GridSprings& grid, std::size_t family) {
    return family > 1 || !arcs_between_neighbours(grid) ? nullptr : family == 0 ? &grid.bend_u : &grid.bend_v;
}

// Two rows at a time, one array per number, as kernels along rows want them; with the columns past a tube's
// seam.
class TransposedRows {
public:
    static constexpr std::size_t numbers = 11;  // x, drift, what springs pull by; ours, mass
    explicit TransposedRows(const Loader& l) : l_(l), stride_(static_cast<std::size_t>(l.nu) + 1) {
        thread_local std::vector<double> memory;
        memory.resize((2 * numbers + 3) * stride_);
        memory_ = memory.data();
    }
    void load(int j) {
        held_[j & 1] = false;
        for (int i = 0; i < l_.nu; ++i) {
            const std::uint32_t p = l_.out.particle(i, j);
            for (int c = 0; c < 3; ++c) {
                row(j, c)[i] = l_.family.at[p][c];
                row(j, 3 + c)[i] = l_.load.drift[p][c];
            }
            row(j, 9)[i] = l_.ours(p);
            row(j, 10)[i] = l_.load.mass[p];
            held_[j & 1] = held_[j & 1] || l_.components.label[p] < 0;
        }
        for (int k = 0; k < static_cast<int>(numbers); ++k) row(j, k)[l_.nu] = row(j, k)[0];
        for (int c = 0; c < 3; ++c) std::fill_n(pull(j)[static_cast<std::size_t>(c)], stride_, 0.0);
    }
    RowEnd end(int j) const {
        return {{row(j, 0), row(j, 1), row(j, 2)}, {row(j, 3), row(j, 4), row(j, 5)}, row(j, 9), row(j, 10)};
    }
    Row pull(int j) const { return {row(j, 6), row(j, 7), row(j, 8)}; }
    // For a row of springs' coefficients: three.
    double* coefficients(std::size_t which) const { return memory_ + (2 * numbers + which) * stride_; }
    bool any_held(int j) const { return held_[j & 1]; }
    // What the column past the seam got is the first one's.
    void fold(int j) const {
        for (double* const y : pull(j)) y[0] += l_.out.grid.tube ? y[l_.nu] : 0.0;
    }

private:
    double* row(int j, int number) const {
        return memory_ +
               (static_cast<std::size_t>(j & 1) * numbers + static_cast<std::size_t>(number)) * stride_;
    }
    const Loader& l_;
    std::size_t stride_;
    double* memory_;
    std::array<bool, 2> held_{false, false};
};

// What neighbours that are held, and move as they must, put into the right-hand side of ours.
void add_held(const Loader& l, const SpringRows& rows, const double* arcs, int j,
              TransposedRows& transposed) {
    const int from_i = static_cast<int>(rows.from[0]), to_i = static_cast<int>(rows.to[0]);
    const int other_j = j + static_cast<int>(rows.to[1]);
    for (std::uint32_t k = 0; k < rows.per_row; ++k) {
        const int i = static_cast<int>(k) + from_i, other_i = static_cast<int>(k) + to_i;
        const std::uint32_t p = l.out.particle(i % l.nu, j), q = l.out.particle(other_i % l.nu, other_j);
        const std::uint32_t s = rows.at(k, static_cast<std::uint32_t>(l.first_row + j));
        const bool implicit = l.family.forces->state[s] == SpringState::implicit;
        const double of_arc = arcs ? arcs[k] : 0.0;
        if (l.ours(p) == l.ours(q) || (!implicit && of_arc == 0)) continue;
        const std::uint32_t held = l.ours(p) ? q : p;
        if (l.components.label[held] >= 0) continue;
        const SpringLine line = line_of(l.family, s);
        const Vec3& u = line.u;
        const double on = implicit ? 1.0 : 0.0, t = on * line.t;
        const double along = on * l.family.springs->stiffness[s] - t + of_arc;
        const double scale = l.h * l.h * along + l.h * on * l.family.springs->damping[s];
        const Vec3& z = l.constraints.find(held)->z;
        const Vec3 pull = l.h * l.h * t * z + scale * u.dot(z) * u;
        const Row to = from(transposed.pull(l.ours(p) ? j : other_j), l.ours(p) ? i : other_i);
        for (std::size_t c = 0; c < 3; ++c) *to[c] += pull[static_cast<Eigen::Index>(c)];
    }
}

// All springs that begin in a row; their blocks only where it is one of the band's.
double couple(const Loader& l, int j, bool ours, TransposedRows& transposed) {
    const ExtensionSprings& springs = *l.family.springs;
    double stiffest = 0;
    for (std::size_t f = 0; f < families.size(); ++f) {
        const SpringRows& rows = l.springs.*families[f];
        const int down = static_cast<int>(rows.to[1]);
        if (l.first_row + j >= static_cast<int>(rows.rows) || j + down >= l.out.grid.nv || rows.per_row == 0)
            continue;
        if (!ours && down == 0) continue;
        const auto from_i = static_cast<std::ptrdiff_t>(rows.from[0]),
                   to_i = static_cast<std::ptrdiff_t>(rows.to[0]);
        const std::uint32_t s = rows.at(0, static_cast<std::uint32_t>(l.first_row + j));
        float* const blocks = l.out.couplings.data() + l.at(0, j, 16) + 4 * static_cast<int>(f) * l.pitch;
        const SpringRows* const along = l.bending.arcs ? arcs_along(l.springs, f) : nullptr;
        const double* const arcs =
            along && along->count() > 0
                ? l.bending.arcs->stiffness.run(along->at(0, static_cast<std::uint32_t>(l.first_row + j)),
                                                rows.per_row, transposed.coefficients(2))
                : nullptr;
        const double most = couple_row(
            transposed.end(j).from(from_i), transposed.end(j + down).from(to_i), springs.rest[s],
            springs.stiffness.run(s, rows.per_row, transposed.coefficients(0)),
            springs.damping.run(s, rows.per_row, transposed.coefficients(1)),
            l.family.forces->state.data() + s, arcs, l.h, rows.per_row, from(transposed.pull(j), from_i),
            from(transposed.pull(j + down), to_i), ours ? blocks : nullptr, l.pitch);
        stiffest = std::max(stiffest, most);
        if (transposed.any_held(j) || transposed.any_held(j + down)) add_held(l, rows, arcs, j, transposed);
    }
    return stiffest;
}

// Bending's stencils through each node: along u, along v, and the twist. Those that are implicit and have a
// node of ours; in single precision, as everything that A is made of. The largest over the mass of its
// middle.
double load_bends(const Loader& l, int j) {
    const GridSprings& grid = l.springs;
    const int row = l.first_row + j;
    double stiffest = 0;
    const auto put = [&](int which, const SpringRows& rows, int i, int base, int base_row) {
        float& to = l.out.bends[static_cast<std::size_t>(l.at(i, j, 3) + which * l.pitch)];
        to = 0;
        if (grid.tube) base = (base + l.nu) % l.nu;
        if (base < 0 || base >= static_cast<int>(rows.per_row) || base_row < 0 ||
            base_row >= static_cast<int>(rows.rows))
            return;
        const std::uint32_t s =
            rows.at(static_cast<std::uint32_t>(base), static_cast<std::uint32_t>(base_row));
        const std::array<std::uint32_t, 4>& p = l.bending.stencils->p[s];
        if (l.bending.is_implicit[s] == 0 || !std::ranges::any_of(p, [&](auto q) { return l.ours(q); }))
            return;
        const double c = l.h * l.h * l.bending.stencils->stiffness[s];
        to = static_cast<float>(c);
        stiffest = std::max(stiffest, 4 * c / l.load.mass[p[1]]);
    };
    for (int i = 0; i < l.nu; ++i) {
        put(0, grid.curve_u, i, i - 1, row);
        put(1, grid.curve_v, i, i, row - 1);
        put(2, grid.twist, i, i, row);
    }
    return stiffest;
}

// What bending pulls by without the solve is K (g/h), and held neighbours move as they must: K s in all, s =
// g/h + z of the held.
void load_shift(const Loader& l, int j, std::vector<double>& shift) {
    for (int i = 0; i < l.nu; ++i) {
        const std::uint32_t p = l.out.particle(i, j);
        Vec3 s = l.load.drift[p] / l.h;
        if (l.components.label[p] < 0) s += l.constraints.find(p)->z;
        for (int k = 0; k < 3; ++k) shift[static_cast<std::size_t>(l.at(i, j, 3) + k * l.pitch)] = s[k];
    }
}

// What nodes have by themselves.
void load_nodes(const Loader& l, int j, const TransposedRows& transposed) {
    GridSystem& out = l.out;
    std::fill_n(out.b.data() + l.at(-StencilGrid::margin, j, 3), 3 * l.pitch, 0.0);
    std::fill_n(out.x.data() + l.at(-StencilGrid::margin, j, 3), 3 * l.pitch, 0.0);
    transposed.fold(j);
    const Row pull = transposed.pull(j);
    float* const active = out.active.data() + l.at(0, j, 1);
    for (int i = 0; i < l.nu; ++i) {
        const std::uint32_t p = out.particle(i, j);
        std::int32_t& slot = out.slot[static_cast<std::size_t>(l.at(i, j, 1))];
        float& mass = out.mass[static_cast<std::size_t>(l.at(i, j, 1))];
        // Others share no spring with the component, or are held and in b already: their x is 0.
        mass = 0;
        active[i] = 0;
        if (!l.ours(p)) continue;
        const Constraint* c = l.constraints.find(p);
        mass = static_cast<float>(l.load.mass[p]);
        slot = !c ? free_slot : c->free == 0 ? masked_slot : slot;
        active[i] = slot == masked_slot ? 0.0f : 1.0f;
        const Vec3& y = l.guess[p];
        const Vec3 x = c ? Vec3(c->S * y + (c->z - c->S * c->z)) : y;
        for (int k = 0; k < 3; ++k) {
            out.x[static_cast<std::size_t>(l.at(i, j, 3) + k * l.pitch)] = x[k];
            out.b[static_cast<std::size_t>(l.at(i, j, 3) + k * l.pitch)] =
                l.load.impulse[p][k] + pull[static_cast<std::size_t>(k)][i];
        }
    }
    if (out.grid.tube) {
        active[-1] = active[l.nu - 1];
        active[l.nu] = active[0];
    }
}

// Rows [begin, end).
double load_rows(const Loader& l, int begin, int end) {
    TransposedRows transposed(l);
    double stiffest = 0;
    const int before = std::max(begin - 1, 0);
    transposed.load(before);
    for (int j = before; j < end; ++j) {
        if (j + 1 < l.out.grid.nv) transposed.load(j + 1);
        stiffest = std::max(stiffest, couple(l, j, j >= begin, transposed));
        if (j < begin) continue;
        load_nodes(l, j, transposed);
        if (!l.bending.any()) continue;
        stiffest = std::max(stiffest, load_bends(l, j));
        load_shift(l, j, l.out.shift);
    }
    return stiffest;
}

}  // namespace

std::size_t GridSystem::field(int numbers) const {
    const int rows8 = (grid.nv + 7) / 8 * 8;
    return static_cast<std::size_t>(rows8) * static_cast<std::size_t>(numbers) *
               static_cast<std::size_t>(grid.pitch) +
           64;
}

RowBands::RowBands(const StencilGrid& g, int at_least) : all(g.nv) {
    constexpr int nodes = 2048;
    rows = std::max({at_least, 1, nodes / std::max(g.nu, 1)});
    count = (all + rows - 1) / rows;
}

void load_grid_system(const GridSprings& springs, const SpringFamily& family, const Load& load,
                      const Components& components, std::uint32_t c, const Constraints& constraints,
                      std::span<const Vec3> guess, double h, GridSystem& out, const GridBending& bending) {
    const std::uint32_t begin = components.start[c], end = components.start[c + 1];
    // With the rows next to it, which may hold neighbours that are held.
    const std::uint32_t reach = bending.any() ? 2 : 1;
    const std::uint32_t top = (components.order[begin] - springs.particle) / springs.nu;
    const std::uint32_t bottom = (components.order[end - 1] - springs.particle) / springs.nu;
    const std::uint32_t first_row = top - std::min(top, reach);
    const std::uint32_t last_row = std::min(bottom + reach, springs.nv - 1);
    StencilGrid& g = out.grid;
    const StencilGrid before = g;
    const std::uint32_t first_before = out.first_particle;
    out.component = c;
    out.rows = end - begin;
    out.first_particle = springs.particle + first_row * springs.nu;
    g.nu = static_cast<int>(springs.nu);
    g.nv = static_cast<int>(last_row - first_row + 1);
    g.pitch = g.columns() + 2 * StencilGrid::margin;
    g.tube = springs.tube;
    // What lies outside the grid stays zero from step to step.
    if (first_before != out.first_particle || before.nu != g.nu || before.nv != g.nv ||
        before.tube != g.tube) {
        out.couplings.assign(out.field(16), 0.0f);
        out.mass.assign(out.field(1), 0.0f);
        out.active.assign(out.field(1), 0.0f);
        out.b.assign(out.field(3), 0.0);
        out.x.assign(out.field(3), 0.0);
        out.D.assign(out.field(6), 0.0f);
        out.P.assign(out.field(6), 0.0f);
    }
    out.slot.assign(out.field(1), masked_slot);
    if (bending.any()) {
        out.bends.assign(out.field(3), 0.0f);
        out.shift.assign(out.field(3), 0.0);
    }
    const Loader loader{springs,
                        family,
                        load,
                        components,
                        constraints,
                        guess,
                        h,
                        bending,
                        out,
                        g.nu,
                        g.pitch,
                        static_cast<std::int32_t>(c),
                        static_cast<int>(first_row)};

    // Directions are numbered in the order of the constraints, which no thread changes.
    out.directions.clear();
    for (const Constraint& held : constraints.all()) {
        if (held.free == 0 || !loader.ours(held.particle)) continue;
        const auto node = static_cast<int>(held.particle - out.first_particle);
        out.slot[static_cast<std::size_t>(loader.at(node % g.nu, node / g.nu, 1))] =
            static_cast<std::int32_t>(out.directions.size() / 6);
        out.directions.resize(out.directions.size() + 6);
        free_directions(held.S, out.directions.data() + out.directions.size() - 6);
    }

    const RowBands bands(g);
    std::vector<double> stiffest(static_cast<std::size_t>(bands.count));
    tbb::parallel_for(0, bands.count, [&](int band) {
        stiffest[static_cast<std::size_t>(band)] = load_rows(loader, bands.begin(band), bands.end(band));
    });
    out.stiffest = *std::max_element(stiffest.begin(), stiffest.end());
    g.couplings = out.couplings.data();
    g.self = out.mass.data();
    g.slot = out.slot.data();
    g.directions = out.directions.data();
    g.bends = bending.any() ? out.bends.data() : nullptr;
    const auto implicit_in = [&](const SpringRows& rows) {
        const auto first = family.forces->state.begin() + rows.first;
        return std::find(first, first + rows.count(), SpringState::implicit) != first + rows.count();
    };
    g.diagonals = implicit_in(springs.diagonal) || implicit_in(springs.anti);
    const StencilKernels& kernels = stencil_kernels();
    tbb::parallel_for(0, bands.count, [&](int band) {
        kernels.sweep.diagonal[0](g, bands.begin(band), bands.end(band), out.D.data());
        if (g.bends) {
            thread_local std::vector<double> scratch;
            scratch.resize(sweep_scratch_rows * static_cast<std::size_t>(g.pitch));
            kernels.bending.take_in_double(g, bands.begin(band), bands.end(band), out.b.data(),
                                           out.shift.data(), out.b.data(), scratch.data());
            kernels.bending.diagonal[0](g, bands.begin(band), bands.end(band), out.D.data());
        }
        kernels.line.invert(g, bands.begin(band), bands.end(band), out.D.data(), out.P.data());
    });
}

}  // namespace unravel::sim
