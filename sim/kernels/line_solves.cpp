// Compiled once for each instruction set (UNRAVEL_ISA names it): include nothing here whose functions could
// be shared with code that must run anywhere.

#include "sim/kernels/stencil_rows.hpp"

namespace unravel::sim::UNRAVEL_ISA {

namespace {

void invert(const StencilGrid& g, int begin, int end, const float* D, float* P) {
    for (int j = begin; j < end; ++j) {
        const float* const from = row_of(D, g, j, 6);
        float* const to = row_of(P, g, j, 6);
        const std::int32_t* const slot = row_of(g.slot, g, j, 1);
        for (int i = 0; i < g.nu; i += 4)
            store6<d4>(to + i, g.pitch, inverse_of(g, load6<d4>(from + i, g.pitch), slot + i, 1));
    }
}

// Block elimination along a line of nodes k with couplings −B_k to the next:
//   E_0 = D_0⁻¹,  E_k = (D_k − B_{k−1} E_{k−1} B_{k−1})⁻¹,  each within the node's free directions,
// so that the line's matrix is that of the constrained system and masked nodes drop out. A solve goes
//   forward   t_k = E_k (r_k + B_{k−1} t_{k−1})       backward   z_k = t_k + E_k B_k z_{k+1}.
template <typename Level>
void factor_v(const StencilGrid& g, int begin, int end, const float* D, float* E) {
    using Coupling = typename Level::Coupling;
    for (int i = begin; i < end; i += 4) {
        Sym3<d4> before;
        for (int j = 0; j < g.nv; ++j) {
            Sym3<d4> d = load6<d4>(row_of(D, g, j, 6) + i, g.pitch);
            if (j > 0) {
                const CouplingRows<Level> above(g, j - 1);
                d = d - sandwiched(as_matrix(Coupling::template load<d4>(above.v + i, g.pitch)), before);
            }
            before = inverse_of(g, d, row_of(g.slot, g, j, 1) + i, 1);
            store6<d4>(row_of(E, g, j, 6) + i, g.pitch, before);
        }
    }
}

template <typename Level>
void solve_v(const StencilGrid& g, int begin, int end, const float* E, float* t, float* z, bool add) {
    using Coupling = typename Level::Coupling;
    constexpr int strip = 64;
    const int pitch = g.pitch;
    for (int i0 = begin; i0 < end; i0 += strip) {
        const int i1 = i0 + strip < end ? i0 + strip : end;
        for (int j = 0; j < g.nv; ++j) {
            float* const tj = row_of(t, g, j, 3);
            const float* const Ej = row_of(E, g, j, 6);
            const CouplingRows<Level> above(g, j > 0 ? j - 1 : 0);
            const float* const t_above = row_of(t, g, j > 0 ? j - 1 : 0, 3);
            for (int i = i0; i < i1; i += 8) {
                V3<f8> y = load3<f8>(tj + i, pitch);
                if (j > 0)
                    y = y + Coupling::template load<f8>(above.v + i, pitch) * load3<f8>(t_above + i, pitch);
                store3<f8>(tj + i, pitch, load6<f8>(Ej + i, pitch) * y);
            }
        }
        // t becomes the line's solution on the way up.
        for (int j = g.nv - 1; j >= 0; --j) {
            float* const tj = row_of(t, g, j, 3);
            float* const zj = row_of(z, g, j, 3);
            const float* const Ej = row_of(E, g, j, 6);
            const CouplingRows<Level> rows(g, j);
            for (int i = i0; i < i1; i += 8) {
                V3<f8> y = load3<f8>(tj + i, pitch);
                if (j + 1 < g.nv) {
                    y = y + load6<f8>(Ej + i, pitch) * (Coupling::template load<f8>(rows.v + i, pitch) *
                                                        load3<f8>(row_of(t, g, j + 1, 3) + i, pitch));
                    store3<f8>(tj + i, pitch, y);
                }
                store3<f8>(zj + i, pitch, add ? load3<f8>(zj + i, pitch) + y : y);
            }
        }
    }
}

// Eight rows of one number become lanes: columns i to i + 7.
UNRAVEL_INLINE void turn(const float* from, std::ptrdiff_t row, float* to, std::ptrdiff_t column) {
    f8 m[8];
    for (int k = 0; k < 8; ++k) m[k] = Lanes<f8>::load(from + k * row);
    transpose(m);
    for (int k = 0; k < 8; ++k) Lanes<f8>::store(to + k * column, m[k]);
}

template <typename Level>
void factor_u(const StencilGrid& g, int block, const float* D, float* lines) {
    using Coupling = typename Level::Coupling;
    constexpr int c = Coupling::numbers, column = 8 * (6 + c);
    const int j = 8 * block, columns = g.columns();
    for (int i = 0; i < columns; i += 8) {
        for (int k = 0; k < 6; ++k)
            turn(row_of(D, g, j, 6) + k * g.pitch + i, 6 * g.pitch, lines + i * column + 8 * k, column);
        for (int k = 0; k < c; ++k)
            turn(row_of(g.couplings, g, j, 4 * c) + k * g.pitch + i, 4 * c * g.pitch,
                 lines + i * column + 8 * (6 + k), column);
    }
    for (int half = 0; half < 8; half += 4) {
        Sym3<d4> before;
        for (int i = 0; i < columns; ++i) {
            float* const at = lines + i * column + half;
            Sym3<d4> d = load6<d4>(at, 8);
            if (i > 0)
                d = d - sandwiched(as_matrix(Coupling::template load<d4>(at - column + 48, 8)), before);
            before = inverse_of(g, d, row_of(g.slot, g, j + half, 1) + i, g.pitch);
            store6<d4>(at, 8, before);
        }
    }
}

template <typename Level>
void solve_u(const StencilGrid& g, int block, const float* lines, const float* t, float* z, bool add,
             float* scratch) {
    using Coupling = typename Level::Coupling;
    constexpr int column = 8 * (6 + Coupling::numbers);
    const int columns = g.columns(), pitch = g.pitch;
    const std::ptrdiff_t row = 3 * pitch;
    const float* const from = row_of(t, g, 8 * block, 3);
    float* const to = row_of(z, g, 8 * block, 3);
    V3<f8> carried{f8{}, f8{}, f8{}};
    for (int i = 0; i < columns; i += 8) {
        for (int c = 0; c < 3; ++c) turn(from + c * pitch + i, row, scratch + 24 * i + 8 * c, 24);
        for (int k = i; k < i + 8; ++k) {
            const float* const at = lines + k * column;
            const V3<f8> tk = load6<f8>(at, 8) * (load3<f8>(scratch + 24 * k, 8) + carried);
            carried = Coupling::template load<f8>(at + 48, 8) * tk;
            store3<f8>(scratch + 24 * k, 8, tk);
        }
    }
    V3<f8> next{f8{}, f8{}, f8{}};
    for (int i = columns - 8; i >= 0; i -= 8) {
        for (int k = i + 7; k >= i; --k) {
            const float* const at = lines + k * column;
            next = load3<f8>(scratch + 24 * k, 8) +
                   load6<f8>(at, 8) * (Coupling::template load<f8>(at + 48, 8) * next);
            store3<f8>(scratch + 24 * k, 8, next);
        }
        for (int c = 0; c < 3; ++c) {
            f8 m[8];
            for (int k = 0; k < 8; ++k) m[k] = Lanes<f8>::load(scratch + 24 * (i + k) + 8 * c);
            transpose(m);
            for (int k = 0; k < 8; ++k) {
                float* const out = to + k * row + c * pitch + i;
                Lanes<f8>::store(out, add ? Lanes<f8>::load(out) + m[k] : m[k]);
            }
        }
    }
}

}  // namespace

extern const LineKernels line_kernels;
const LineKernels line_kernels = {
    invert,
    {factor_v<Fine>, factor_v<Coarse>},
    {solve_v<Fine>, solve_v<Coarse>},
    {factor_u<Fine>, factor_u<Coarse>},
    {solve_u<Fine>, solve_u<Coarse>},
};

}  // namespace unravel::sim::UNRAVEL_ISA
