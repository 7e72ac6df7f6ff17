#include "sim/kernels/grid_system.hpp"

#include <algorithm>
#include <cmath>

namespace unravel {

namespace {

constexpr int margin = StencilGrid::margin;

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
    const SpringFamily& family;
    const Load& load;
    const Components& components;
    const Constraints& constraints;
    double h;
    GridSystem& out;
    int nu, pitch;
    std::int32_t label;

    bool ours(std::uint32_t p) const { return components.label[p] == label; }
    std::ptrdiff_t at(int i, int j, int numbers) const {
        return static_cast<std::ptrdiff_t>(j) * numbers * pitch + margin + i;
    }
    void add(std::vector<double>& field, int i, int j, const Vec3& v) const {
        double* const p = field.data() + at(i, j, 3);
        for (int c = 0; c < 3; ++c) p[c * pitch] += v[c];
    }
    // What the neighbour `other` of p in the component, held fully, puts into p's right-hand side.
    Vec3 pull(std::uint32_t other, double a, double scale, const Vec3& u) const {
        if (components.label[other] >= 0) return Vec3::Zero();
        const Vec3& z = constraints.find(other)->z;
        return a * z + scale * u.dot(z) * u;
    }

    // One spring from node (i, j) to (i2, j2): its block at `slot` of (column, j), its share of b in rows
    // [begin, end).
    void spring(std::uint32_t s, int i, int j, int i2, int j2, float* slot, int begin, int end,
                double& stiffest) const {
        float block[4] = {0, 0, 0, 0};
        if (family.forces->state[s] == SpringState::implicit) {
            const std::uint32_t p = out.particle(i, j), q = out.particle(i2, j2);
            const bool p_ours = ours(p), q_ours = ours(q);
            if (p_ours || q_ours) {
                const auto line = line_of(family, s);
                const Vec3& u = line.u;
                const double k = family.springs->stiffness[s], t = line.t;
                const double a = h * h * t, scale = h * h * (k - t) + h * family.springs->damping[s];
                const double root = std::sqrt(scale);
                block[0] = static_cast<float>(a);
                for (int c = 0; c < 3; ++c) block[c + 1] = static_cast<float>(root * u[c]);
                stiffest = std::max(stiffest, (a + scale) / std::min(load.mass[p], load.mass[q]));
                const Vec3 g = load.drift[q] - load.drift[p];
                const Vec3 kick = h * (t * g + (k - t) * u.dot(g) * u);
                if (p_ours && j >= begin && j < end) add(out.b, i, j, kick + pull(q, a, scale, u));
                if (q_ours && j2 >= begin && j2 < end) add(out.b, i2, j2, pull(p, a, scale, u) - kick);
            }
        }
        if (j < begin) return;
        for (int c = 0; c < 4; ++c) slot[c * pitch] = block[c];
    }
};

// Rows [begin, end): node by node, then the springs that touch them.
double load_rows(const Loader& l, const GridSprings& g, std::span<const Vec3> guess, int first_row, int begin,
                 int end) {
    GridSystem& out = l.out;
    for (int j = begin; j < end; ++j) {
        std::fill_n(out.b.data() + l.at(-margin, j, 3), 3 * l.pitch, 0.0);
        std::fill_n(out.x.data() + l.at(-margin, j, 3), 3 * l.pitch, 0.0);
        for (int i = 0; i < l.nu; ++i) {
            const std::uint32_t p = out.particle(i, j);
            const Constraint* c = l.constraints.find(p);
            std::int32_t& slot = out.slot[static_cast<std::size_t>(l.at(i, j, 1))];
            float& mass = out.mass[static_cast<std::size_t>(l.at(i, j, 1))];
            const Vec3& y = guess[p];
            // Others share no spring with the component, or are held and in b already: their x is 0.
            if (!l.ours(p)) {
                mass = 0;
                continue;
            }
            mass = static_cast<float>(l.load.mass[p]);
            slot = !c ? free_slot : c->free == 0 ? masked_slot : slot;
            l.add(out.x, i, j, c ? Vec3(c->S * y + (c->z - c->S * c->z)) : y);
            l.add(out.b, i, j, l.load.impulse[p]);
        }
        float* const active = out.active.data() + l.at(0, j, 1);
        for (int i = 0; i < l.nu; ++i)
            active[i] = out.slot[static_cast<std::size_t>(l.at(i, j, 1))] == masked_slot ? 0.0f : 1.0f;
        if (out.grid.tube) {
            active[-1] = active[l.nu - 1];
            active[l.nu] = active[0];
        }
    }
    double stiffest = 0;
    const SpringRows* const families[] = {&g.u, &g.v, &g.diagonal, &g.anti};
    for (int j = std::max(begin - 1, 0); j < end; ++j) {
        for (int f = 0; f < 4; ++f) {
            const SpringRows& rows = *families[f];
            const int from_i = static_cast<int>(rows.from[0]), to_i = static_cast<int>(rows.to[0]);
            const int down = static_cast<int>(rows.to[1]);
            if (first_row + j >= static_cast<int>(rows.rows) || j + down >= out.grid.nv) continue;
            float* const base = out.couplings.data() + l.at(0, j, 16) + 4 * f * l.pitch;
            const auto s0 = rows.at(0, static_cast<std::uint32_t>(first_row + j));
            for (int k = 0; k < static_cast<int>(rows.per_row); ++k) {
                const int i = k + from_i < l.nu ? k + from_i : k + from_i - l.nu;
                const int i2 = k + to_i < l.nu ? k + to_i : k + to_i - l.nu;
                l.spring(s0 + static_cast<std::uint32_t>(k), i, j, i2, j + down, base + k, begin, end,
                         stiffest);
            }
        }
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
                      std::span<const Vec3> guess, double h, GridSystem& out) {
    const std::uint32_t begin = components.start[c], end = components.start[c + 1];
    // With the rows next to it, which may hold neighbours that are held.
    const std::uint32_t top = (components.order[begin] - springs.particle) / springs.nu;
    const std::uint32_t bottom = (components.order[end - 1] - springs.particle) / springs.nu;
    const std::uint32_t first_row = top > 0 ? top - 1 : top;
    const std::uint32_t last_row = bottom + 1 < springs.nv ? bottom + 1 : bottom;
    StencilGrid& g = out.grid;
    const StencilGrid before = g;
    const std::uint32_t first_before = out.first_particle;
    out.component = c;
    out.rows = end - begin;
    out.first_particle = springs.particle + first_row * springs.nu;
    g.nu = static_cast<int>(springs.nu);
    g.nv = static_cast<int>(last_row - first_row + 1);
    g.pitch = g.columns() + 2 * margin;
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
    Loader loader{family, load, components, constraints, h, out, g.nu, g.pitch, static_cast<std::int32_t>(c)};

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
        stiffest[static_cast<std::size_t>(band)] = load_rows(
            loader, springs, guess, static_cast<int>(first_row), bands.begin(band), bands.end(band));
    });
    out.stiffest = *std::max_element(stiffest.begin(), stiffest.end());
    g.couplings = out.couplings.data();
    g.self = out.mass.data();
    g.slot = out.slot.data();
    g.directions = out.directions.data();
    const auto implicit_in = [&](const SpringRows& rows) {
        const auto first = family.forces->state.begin() + rows.first;
        return std::find(first, first + rows.count(), SpringState::implicit) != first + rows.count();
    };
    g.diagonals = implicit_in(springs.diagonal) || implicit_in(springs.anti);
    const StencilKernels& kernels = stencil_kernels();
    tbb::parallel_for(0, bands.count, [&](int band) {
        kernels.sweep.diagonal[0](g, bands.begin(band), bands.end(band), out.D.data());
        kernels.line.invert(g, bands.begin(band), bands.end(band), out.D.data(), out.P.data());
    });
}

}  // namespace unravel
