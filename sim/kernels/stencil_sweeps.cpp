// Compiled once for each instruction set (UNRAVEL_ISA names it): include nothing here whose functions could
// be shared with code that must run anywhere.

#include "sim/kernels/stencil_rows.hpp"

namespace unravel::sim::UNRAVEL_ISA {

namespace {

// A's product in one sweep down the rows. The flux B (p_a − p_b) of each coupling is evaluated once: it
// leaves b and enters a,
//
//     a = (i, j) ──u── (i+1, j)          q(i, j)     += u + v + diagonal
//         │  ╲      ╱                    q(i+1, j)   += anti − u
//         v  diagonal, anti              q(i, j+1)   −= v + anti
//         │  ╱      ╲                    q(i+1, j+1) −= diagonal
//
// What goes to the right is passed on in registers, what goes down through two rows of scratch that take
// turns.
template <typename T>
struct Carry {
    using E = typename Lanes<T>::Element;
    E* below[2];   // v + anti
    E* beside[2];  // diagonal
    UNRAVEL_INLINE Carry(E* scratch, int pitch) {
        for (int k = 0; k < 2; ++k) {
            below[k] = scratch + (6 * k) * pitch + margin;
            beside[k] = scratch + (6 * k + 3) * pitch + margin;
            // Before the first column nothing comes from the left; past the last nothing is read but zeros.
            for (int c = 0; c < 3; ++c) beside[k][c * pitch - 1] = 0;
        }
    }
};

// Row j: p and p_below are rows of p; emit(i, p, q) takes each vector of q. The ring of p's rows is closed.
template <typename Level, typename T, bool with_diagonals, typename E, typename F>
UNRAVEL_INLINE void stencil_row(const StencilGrid& g, int j, const E* p, const E* p_below, Carry<T>& carry,
                                bool first, const F& emit) {
    using Coupling = typename Level::Coupling;
    constexpr int lanes = Lanes<T>::count;
    const int pitch = g.pitch;
    const CouplingRows<Level> rows(g, j);
    const float* const self = row_of(g.self, g, j, Level::Self::numbers);
    E* const below = carry.below[j & 1];
    E* const beside = carry.beside[j & 1];
    const E* const above = carry.below[(j & 1) ^ 1];
    const E* const above_beside = carry.beside[(j & 1) ^ 1];
    V3<T> right_before{T{}, T{}, T{}};
    if (g.tube) {
        // The last column's flux to the right enters the first column.
        const int i = g.nu - 1;
        using S = E;
        const V3<S> here = load3<S>(p + i, pitch), next = load3<S>(p + i + 1, pitch);
        V3<S> right = Coupling::template load<S>(rows.u + i, pitch) * (next - here);
        if constexpr (with_diagonals)
            right = right +
                    Coupling::template load<S>(rows.anti + i, pitch) * (next - load3<S>(p_below + i, pitch));
        right_before.x[lanes - 1] = right.x;
        right_before.y[lanes - 1] = right.y;
        right_before.z[lanes - 1] = right.z;
    }
    for (int i = 0; i < g.nu; i += lanes) {
        const V3<T> here = load3<T>(p + i, pitch), next = load3<T>(p + i + 1, pitch);
        const V3<T> under = load3<T>(p_below + i, pitch);
        const V3<T> u = Coupling::template load<T>(rows.u + i, pitch) * (here - next);
        const V3<T> v = Coupling::template load<T>(rows.v + i, pitch) * (here - under);
        V3<T> q = Level::Self::template times<T>(self + i, pitch, here) + (u + v);
        V3<T> right = V3<T>{T{}, T{}, T{}} - u;
        V3<T> down = v;
        if constexpr (with_diagonals) {
            const V3<T> under_next = load3<T>(p_below + i + 1, pitch);
            const V3<T> diagonal = Coupling::template load<T>(rows.diagonal + i, pitch) * (here - under_next);
            const V3<T> anti = Coupling::template load<T>(rows.anti + i, pitch) * (next - under);
            q = q + diagonal;
            right = right + anti;
            down = down + anti;
            store3<T>(beside + i, pitch, diagonal);
        }
        store3<T>(below + i, pitch, down);
        if (!first) {
            q = q + shifted(right_before, right);
            right_before = right;
            q = q - load3<T>(above + i, pitch);
            if constexpr (with_diagonals) q = q - load3<T>(above_beside + i - 1, pitch);
            emit(i, here, q);
        }
    }
    if constexpr (with_diagonals) {
        if (g.tube)
            for (int c = 0; c < 3; ++c) beside[c * pitch - 1] = beside[c * pitch + g.nu - 1];
    }
}

// Rows [begin, end): the row above gives its carry only. at(j) is row j of p, made when it is first asked
// for.
template <typename Level, typename T, bool with_diagonals, typename Row, typename Emit, typename After>
UNRAVEL_INLINE void stencil_rows(const StencilGrid& g, int begin, int end,
                                 typename Lanes<T>::Element* scratch, const Row& at, const Emit& emit,
                                 const After& after) {
    using E = typename Lanes<T>::Element;
    Carry<T> carry(scratch, g.pitch);
    const E* here;
    if (begin > 0) {
        const E* const above = at(begin - 1);
        here = at(begin);
        stencil_row<Level, T, with_diagonals>(g, begin - 1, above, here, carry, true,
                                              [](int, V3<T>, V3<T>) {});
    } else {
        here = at(0);
        clear(scratch + 6 * g.pitch, 6 * g.pitch);
    }
    for (int j = begin; j < end; ++j) {
        const E* const under = j + 1 < g.nv ? at(j + 1) : here;
        stencil_row<Level, T, with_diagonals>(g, j, here, under, carry, false,
                                              [&](int i, V3<T> p, V3<T> q) { emit(j, i, p, q); });
        after(j);
        here = under;
    }
}

// Sum of lanes, in one order.
UNRAVEL_INLINE double sum_of(d4 v) {
    return (v[0] + v[2]) + (v[1] + v[3]);
}
// Eight products, summed per lane in double.
struct Sum {
    d4 low{}, high{};
    UNRAVEL_INLINE void add(f8 v) {
        low += __builtin_convertvector(__builtin_shufflevector(v, v, 0, 1, 2, 3), d4);
        high += __builtin_convertvector(__builtin_shufflevector(v, v, 4, 5, 6, 7), d4);
    }
    UNRAVEL_INLINE void add(d4 v) { low += v; }
    UNRAVEL_INLINE double total() const { return sum_of(low + high); }
};

template <bool with_diagonals>
UNRAVEL_INLINE void direction_rows(const StencilGrid& g, int begin, int end, float beta, const float* z,
                                   const float* p, float* p_next, float* q, double* dots, float* scratch) {
    // Rows of p' that another band writes are made here too, in scratch of our own.
    float* const own[2] = {scratch + 12 * g.pitch + margin, scratch + 15 * g.pitch + margin};
    const f8 b = {beta, beta, beta, beta, beta, beta, beta, beta};
    for (float* o : own) clear(o - margin, 3 * g.pitch);
    const auto at = [&](int j) -> const float* {
        float* const to = j < begin ? own[0] : j >= end ? own[1] : row_of(p_next, g, j, 3);
        const float *const from = row_of(p, g, j, 3), *const add = row_of(z, g, j, 3);
        for (int c = 0; c < 3; ++c) {
            for (int i = 0; i < g.nu; i += 8) {
                const int k = c * g.pitch + i;
                Lanes<f8>::store(to + k, Lanes<f8>::load(add + k) + b * Lanes<f8>::load(from + k));
            }
        }
        close_ring(to, g, 3);
        return to;
    };
    Sum sum;
    stencil_rows<Fine, f8, with_diagonals>(
        g, begin, end, scratch, at,
        [&](int j, int i, V3<f8> pv, V3<f8> qv) {
            store3<f8>(row_of(q, g, j, 3) + i, g.pitch, qv);
            f8 product = dot(pv, qv);
            // Past a tube's last column p repeats the first.
            if (g.tube && i + 8 > g.nu)
                for (int k = g.nu - i; k < 8; ++k) product[k] = 0;
            sum.add(product);
        },
        [&](int j) {
            filter_row(g, j, row_of(q, g, j, 3));
            open_ring(row_of(p_next, g, j, 3), g, 3);
            dots[j] = sum.total();
            sum = {};
        });
}

void direction(const StencilGrid& g, int begin, int end, float beta, const float* z, const float* p,
               float* p_next, float* q, double* dots, float* scratch) {
    if (g.diagonals)
        direction_rows<true>(g, begin, end, beta, z, p, p_next, q, dots, scratch);
    else
        direction_rows<false>(g, begin, end, beta, z, p, p_next, q, dots, scratch);
}

void advance(const StencilGrid& g, int begin, int end, float alpha, const float* p, const float* q, float* x,
             float* r, const float* P, float* z, double* dots) {
    const f8 a = {alpha, alpha, alpha, alpha, alpha, alpha, alpha, alpha};
    for (int j = begin; j < end; ++j) {
        const std::ptrdiff_t at = row_of(p, g, j, 3) - p;
        const float* const block = row_of(P, g, j, 6);
        Sum sum;
        for (int i = 0; i < g.nu; i += 8) {
            const std::ptrdiff_t k = at + i;
            store3<f8>(x + k, g.pitch, load3<f8>(x + k, g.pitch) + a * load3<f8>(p + k, g.pitch));
            const V3<f8> rk = load3<f8>(r + k, g.pitch) - a * load3<f8>(q + k, g.pitch);
            store3<f8>(r + k, g.pitch, rk);
            const V3<f8> zk = load6<f8>(block + i, g.pitch) * rk;
            if (z) store3<f8>(z + k, g.pitch, zk);
            sum.add(dot(rk, zk));
        }
        dots[j] = sum.total();
    }
}

template <bool with_diagonals>
UNRAVEL_INLINE void residual_rows(const StencilGrid& g, int begin, int end, const double* b, const double* x,
                                  const float* P, float* r, double* dots, double* scratch) {
    stencil_rows<Fine, d4, with_diagonals>(
        g, begin, end, scratch, [&](int j) { return row_of(x, g, j, 3); },
        [&](int j, int i, V3<d4>, V3<d4> q) {
            store3<d4>(row_of(r, g, j, 3) + i, g.pitch, load3<d4>(row_of(b, g, j, 3) + i, g.pitch) - q);
        },
        [&](int j) {
            float* const rj = row_of(r, g, j, 3);
            for (int c = 0; c < 3; ++c)
                for (int i = g.nu; i < g.columns(); ++i) rj[c * g.pitch + i] = 0;
            filter_row(g, j, rj);
            const float* const block = row_of(P, g, j, 6);
            Sum sum;
            for (int i = 0; i < g.nu; i += 4) {
                const V3<d4> rk = load3<d4>(rj + i, g.pitch);
                sum.add(dot(rk, load6<d4>(block + i, g.pitch) * rk));
            }
            dots[j] = sum.total();
        });
}

void residual(const StencilGrid& g, int begin, int end, const double* b, const double* x, const float* P,
              float* r, double* dots, double* scratch) {
    if (g.diagonals)
        residual_rows<true>(g, begin, end, b, x, P, r, dots, scratch);
    else
        residual_rows<false>(g, begin, end, b, x, P, r, dots, scratch);
}

template <typename Level, bool with_diagonals>
UNRAVEL_INLINE void defect_rows(const StencilGrid& g, int begin, int end, const float* r, const float* z,
                                float* t, float* scratch) {
    stencil_rows<Level, f8, with_diagonals>(
        g, begin, end, scratch, [&](int j) { return row_of(z, g, j, 3); },
        [&](int j, int i, V3<f8>, V3<f8> q) {
            store3<f8>(row_of(t, g, j, 3) + i, g.pitch, load3<f8>(row_of(r, g, j, 3) + i, g.pitch) - q);
        },
        [&](int j) {
            float* const tj = row_of(t, g, j, 3);
            for (int c = 0; c < 3; ++c)
                for (int i = g.nu; i < g.columns(); ++i) tj[c * g.pitch + i] = 0;
            filter_row(g, j, tj);
        });
}

template <typename Level>
void defect(const StencilGrid& g, int begin, int end, const float* r, const float* z, float* t,
            float* scratch) {
    if (g.diagonals)
        defect_rows<Level, true>(g, begin, end, r, z, t, scratch);
    else
        defect_rows<Level, false>(g, begin, end, r, z, t, scratch);
}

template <typename Level>
void diagonal(const StencilGrid& g, int begin, int end, float* D) {
    using Coupling = typename Level::Coupling;
    constexpr int c = Coupling::numbers;
    const int pitch = g.pitch;
    for (int j = begin; j < end; ++j) {
        const CouplingRows<Level> rows(g, j);
        const CouplingRows<Level> above(g, j > 0 ? j - 1 : 0);
        const float* const self = row_of(g.self, g, j, Level::Self::numbers);
        float* const out = row_of(D, g, j, 6);
        const auto sum = [&]<typename T>(T, int i, int left) {
            const auto block = [&](const float* at) {
                return as_matrix(Coupling::template load<T>(at, pitch));
            };
            Sym3<T> m = Level::Self::template block<T>(self + i, pitch) + block(rows.u + i) +
                        block(rows.v + i) + block(rows.u + left);
            if (g.diagonals) m = m + block(rows.diagonal + i) + block(rows.anti + left);
            if (j > 0) {
                m = m + block(above.v + i);
                if (g.diagonals) m = m + block(above.diagonal + left) + block(above.anti + i);
            }
            return m;
        };
        static_assert(c == 4 || c == 6);
        for (int i = 0; i < g.nu; i += 8) store6<f8>(out + i, pitch, sum(f8{}, i, i - 1));
        if (g.tube) {
            const Sym3<float> m = sum(0.0f, 0, g.nu - 1);
            out[0] = m.xx, out[pitch] = m.xy, out[2 * pitch] = m.xz;
            out[3 * pitch] = m.yy, out[4 * pitch] = m.yz, out[5 * pitch] = m.zz;
        }
    }
}

}  // namespace

extern const SweepKernels sweep_kernels;
const SweepKernels sweep_kernels = {
    direction, advance, residual, {defect<Fine>, defect<Coarse>}, {diagonal<Fine>, diagonal<Coarse>},
};

}  // namespace unravel::sim::UNRAVEL_ISA
