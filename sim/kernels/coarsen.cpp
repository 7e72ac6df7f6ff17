// Compiled once for each instruction set (UNRAVEL_ISA names it): include nothing here whose functions could
// be shared with code that must run anywhere.

#include "sim/kernels/stencil_rows.hpp"

namespace unravel::sim::UNRAVEL_ISA {

namespace {

// Where the four directions lead: from (i + from, j) to (i + to, j + down).
struct Way {
    int from, to, down;
};
constexpr Way ways[4] = {{0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};

// Every second lane.
UNRAVEL_INLINE f8 even_lanes(const float* v) {
    return __builtin_shufflevector(Lanes<f8>::load(v), Lanes<f8>::load(v + 8), 0, 2, 4, 6, 8, 10, 12, 14);
}
UNRAVEL_INLINE Sym3<f8> even_blocks(Springs, const float* p, int pitch) {
    return as_matrix(SpringBlock<f8>{
        even_lanes(p), {even_lanes(p + pitch), even_lanes(p + 2 * pitch), even_lanes(p + 3 * pitch)}});
}
UNRAVEL_INLINE Sym3<f8> even_blocks(Blocks, const float* p, int pitch) {
    return {even_lanes(p),
            even_lanes(p + pitch),
            even_lanes(p + 2 * pitch),
            even_lanes(p + 3 * pitch),
            even_lanes(p + 4 * pitch),
            even_lanes(p + 5 * pitch)};
}
UNRAVEL_INLINE Sym3<f8> times(f8 s, Sym3<f8> m) {
    return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
}
UNRAVEL_INLINE Sym3<f8> evens_self(Mass, const float* p, int) {
    const f8 m = even_lanes(p), zero{};
    return {m, zero, zero, m, zero, m};
}
UNRAVEL_INLINE Sym3<f8> evens_self(OwnBlock, const float* p, int pitch) {
    return even_blocks(Blocks{}, p, pitch);
}

UNRAVEL_INLINE Sym3<float> block_at(Springs, const float* p, int pitch) {
    return as_matrix(Springs::load<float>(p, pitch));
}
UNRAVEL_INLINE Sym3<float> block_at(Blocks, const float* p, int pitch) {
    return Blocks::load<float>(p, pitch);
}
UNRAVEL_INLINE void add_to(float* p, int pitch, float s, Sym3<float> m) {
    p[0] += s * m.xx, p[pitch] += s * m.xy, p[2 * pitch] += s * m.xz;
    p[3 * pitch] += s * m.yy, p[4 * pitch] += s * m.yz, p[5 * pitch] += s * m.zz;
}

// What springs to masked nodes hold an aggregate with, whole within it and halved across; and c (I − S), c =
// trace(D)/3, of partly constrained nodes: the aggregate is held where its node is.
template <typename Level>
void add_ground(const StencilGrid& g, const float* D, const StencilGrid& coarse, int j, float* self) {
    using Coupling = typename Level::Coupling;
    constexpr int c = Coupling::numbers;
    const auto slot_of = [&](int i, int k) { return row_of(g.slot, g, k, 1)[i]; };
    bool plain = true;
    for (int k = j > 0 ? j - 1 : 0; k <= j + 1 && k < g.nv; ++k)
        for (int i = 0; i < g.nu; ++i) plain = plain && slot_of(i, k) == free_slot;
    if (plain) return;
    for (int i = 0; i < g.nu; ++i) {
        const std::int32_t slot = slot_of(i, j);
        if (slot == masked_slot) continue;
        float* const to = row_of(self, coarse, j / 2, 6) + i / 2;
        if (slot >= 0) {
            const float* const d = row_of(D, g, j, 6) + i;
            const float s = (d[0] + d[3 * g.pitch] + d[5 * g.pitch]) / 3.0f;
            const double* const t = g.directions + 6 * slot;
            const auto out = [&](int a, int b) {
                return static_cast<float>((a == b ? 1.0 : 0.0) - t[a] * t[b] - t[3 + a] * t[3 + b]);
            };
            add_to(to, coarse.pitch, s, {out(0, 0), out(0, 1), out(0, 2), out(1, 1), out(1, 2), out(2, 2)});
        }
        for (int k = 0; k < 8; ++k) {
            const Way& way = ways[k / 2];
            const bool first = k % 2 == 0;
            int base = i - (first ? way.from : way.to);
            const int base_row = first ? j : j - way.down;
            if (base < 0 && g.tube) base += g.nu;
            if (base < 0 || base_row < 0) continue;
            int other = base + (first ? way.to : way.from);
            const int other_row = base_row + (first ? way.down : 0);
            if (other >= g.nu && g.tube) other -= g.nu;
            if (other >= g.nu || other_row >= g.nv || slot_of(other, other_row) != masked_slot) continue;
            const float* const from = row_of(g.couplings, g, base_row, 4 * c) + (k / 2) * c * g.pitch + base;
            const bool within = other / 2 == i / 2 && other_row / 2 == j / 2;
            add_to(to, coarse.pitch, within ? 1.0f : 0.5f, block_at(Coupling{}, from, g.pitch));
        }
    }
}

// The aggregate that the end of an odd tube leaves with a single column: its couplings go round to column 0.
template <typename Level>
void close_odd_tube(const StencilGrid& g, const float* active, const StencilGrid& coarse, int J,
                    float* couplings) {
    using Coupling = typename Level::Coupling;
    constexpr int c = Coupling::numbers;
    const int i = g.nu - 1;
    float* const out = row_of(couplings, coarse, J, 24) + coarse.nu - 1;
    for (int k = 0; k < 24; ++k) out[k * coarse.pitch] = 0;
    for (int j = 2 * J; j < 2 * J + 2 && j < g.nv; ++j) {
        for (int d = 0; d < 4; ++d) {
            const Way& way = ways[d];
            const int a = (i + way.from) % g.nu, b = (i + way.to) % g.nu, below = j + way.down;
            if (below >= g.nv) continue;
            const bool across = d != 1, down = below / 2 != j / 2;
            if (!across && !down) continue;
            const float both = row_of(active, g, j, 1)[a] * row_of(active, g, below, 1)[b];
            const int into = !across ? 1 : !down ? 0 : d;
            add_to(out + 6 * into * coarse.pitch, coarse.pitch, 0.5f * both,
                   block_at(Coupling{}, row_of(g.couplings, g, j, 4 * c) + d * c * g.pitch + i, g.pitch));
        }
    }
}

template <typename Level>
void coarsen(const StencilGrid& g, const float* D, const float* active, const StencilGrid& coarse, int begin,
             int end, float* couplings, float* self, std::int32_t* slot, float* coarse_active) {
    using Coupling = typename Level::Coupling;
    using Self = typename Level::Self;
    constexpr int c = Coupling::numbers;
    constexpr f8 half = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    for (int J = begin; J < end; ++J) {
        const int j = 2 * J;
        float* const out = row_of(couplings, coarse, J, 24);
        float* const own = row_of(self, coarse, J, 6);
        for (int I = 0; I < coarse.nu; I += 8) {
            Sym3<f8> sum[5] = {};
            f8 any{};
            for (int row = j; row < j + 2 && row < g.nv; ++row) {
                const float* const at = row_of(g.couplings, g, row, 4 * c);
                const bool last = row == j + 1, below = row + 1 < g.nv;
                const float* const act = row_of(active, g, row, 1);
                const float* const act_below = row_of(active, g, below ? row + 1 : row, 1);
                const auto take = [&](int into, int d, int side) {
                    const int i = 2 * I + side;
                    const f8 both = even_lanes(act + i + ways[d].from) *
                                    even_lanes((ways[d].down ? act_below : act) + i + ways[d].to);
                    sum[into] = sum[into] + times(half * both,
                                                  even_blocks(Coupling{}, at + d * c * g.pitch + i, g.pitch));
                };
                take(0, 0, 1);
                if (last) {
                    take(1, 1, 0);
                    take(1, 1, 1);
                }
                if (g.diagonals) {
                    for (int d = 2; d < 4; ++d) {
                        if (last) take(1, d, 0);
                        take(last ? d : 0, d, 1);
                    }
                }
                for (int side = 0; side < 2; ++side) {
                    const int i = 2 * I + side;
                    const f8 a = even_lanes(act + i);
                    any = any + a;
                    sum[4] = sum[4] +
                             times(a, evens_self(Self{}, row_of(g.self, g, row, Self::numbers) + i, g.pitch));
                }
            }
            for (int d = 0; d < 4; ++d) store6<f8>(out + 6 * d * coarse.pitch + I, coarse.pitch, sum[d]);
            store6<f8>(own + I, coarse.pitch, sum[4]);
            // Past the end of an odd tube stands its first column, which is not of the last aggregate.
            if (g.tube && g.nu % 2 == 1 && coarse.nu - 1 < I + 8) {
                float alone = 0;
                for (int row = j; row < j + 2 && row < g.nv; ++row)
                    alone += row_of(active, g, row, 1)[g.nu - 1];
                any[coarse.nu - 1 - I] = alone;
            }
            for (int k = 0; k < 8 && I + k < coarse.nu; ++k) {
                row_of(slot, coarse, J, 1)[I + k] = any[k] > 0 ? free_slot : masked_slot;
                row_of(coarse_active, coarse, J, 1)[I + k] = any[k] > 0 ? 1.0f : 0.0f;
            }
        }
        // Past the last node nothing may stand.
        for (int i = coarse.nu; i < coarse.columns(); ++i) {
            for (int k = 0; k < 24; ++k) out[k * coarse.pitch + i] = 0;
            for (int k = 0; k < 6; ++k) own[k * coarse.pitch + i] = 0;
        }
        if (g.tube && g.nu % 2 == 1) close_odd_tube<Level>(g, active, coarse, J, couplings);
        if (coarse.tube) {
            float* const a = row_of(coarse_active, coarse, J, 1);
            a[-1] = a[coarse.nu - 1];
            a[coarse.nu] = a[0];
        }
        for (int row = j; row < j + 2 && row < g.nv; ++row) add_ground<Level>(g, D, coarse, row, self);
    }
}

}  // namespace

extern const CoarsenKernels coarsen_kernels;
const CoarsenKernels coarsen_kernels = {{coarsen<Fine>, coarsen<Coarse>}};

}  // namespace unravel::sim::UNRAVEL_ISA
