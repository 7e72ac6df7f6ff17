// Compiled once for each instruction set (UNRAVEL_ISA names it): include nothing here whose functions could
// be shared with code that must run anywhere.

#include "sim/kernels/stencil_rows.hpp"

namespace unravel::sim::UNRAVEL_ISA {

namespace {

// Of a block's six numbers those on its diagonal.
constexpr int on_trace[3] = {0, 3, 5};

// The coefficients of row j: of the curvature along u, along v, and of the twist.
UNRAVEL_INLINE const float* bend_row_of(const StencilGrid& g, int j, int which) {
    return row_of(g.bends, g, j, 3) + which * g.pitch;
}

// Bending's product K p, row by row. What each stencil feels, c y, is evaluated once,
//
//   U(i, j) = c_u (p(i−1, j) − 2 p(i, j) + p(i+1, j))          V likewise along v
//   W(i, j) = c_w (p(i, j) − p(i+1, j) + p(i+1, j+1) − p(i, j+1))
//
// and given to its nodes with its weights:
//
//   K p = U(i−1) − 2 U(i) + U(i+1)  +  V(j−1) − 2 V(j) + V(j+1)
//       + W(i, j) − W(i−1, j) − W(i, j−1) + W(i−1, j−1)
template <typename T>
class BentRows {
public:
    using E = typename Lanes<T>::Element;
    static constexpr int scratch_rows = 18;
    UNRAVEL_INLINE BentRows(const StencilGrid& g, const E* p, E* scratch, int begin) : g_(g), p_(p) {
        along_ = scratch + margin;
        for (int k = 0; k < 3; ++k) down_[k] = scratch + 3 * (1 + k) * g.pitch + margin;
        for (int k = 0; k < 2; ++k) twist_[k] = scratch + 3 * (4 + k) * g.pitch + margin;
        // What is read past the last vector stays zero.
        clear(scratch, 3 * g.pitch);
        make_down(begin - 1);
        make_down(begin);
        make_twist(begin - 1);
    }
    // Rows come one after the other. emit(i, p, K p) of each vector of row j.
    template <typename F>
    UNRAVEL_INLINE void row(int j, const F& emit) {
        make_along(j);
        make_down(j + 1);
        make_twist(j);
        const int pitch = g_.pitch;
        const E *const p = at(j), *const before = down(j - 1), *const here = down(j),
                       *const after = down(j + 1), *const twist = this->twist(j),
                       *const above = this->twist(j - 1);
        for (int i = 0; i < g_.nu; i += Lanes<T>::count) {
            const auto of = [&](const E* from, int k) { return load3<T>(from + k, pitch); };
            const V3<T> u = second(of(along_, i - 1), of(along_, i), of(along_, i + 1));
            const V3<T> v = second(of(before, i), of(here, i), of(after, i));
            const V3<T> w = (of(twist, i) - of(twist, i - 1)) - (of(above, i) - of(above, i - 1));
            emit(i, of(p, i), (u + v) + w);
        }
    }

private:
    template <typename S>
    static UNRAVEL_INLINE V3<S> second(V3<S> before, V3<S> here, V3<S> after) {
        return (before + after) - (here + here);
    }
    UNRAVEL_INLINE const E* at(int j) const {
        return row_of(p_, g_, j < 0 ? 0 : j < g_.nv ? j : g_.nv - 1, 3);
    }
    UNRAVEL_INLINE E* down(int j) const { return down_[(j + 3) % 3]; }
    UNRAVEL_INLINE E* twist(int j) const { return twist_[j & 1]; }
    // What lies beside a row: nothing, or where a tube closes the other end.
    UNRAVEL_INLINE void end_row(E* row) const {
        for (int c = 0; c < 3; ++c, row += g_.pitch) {
            row[-1] = g_.tube ? row[g_.nu - 1] : 0;
            row[g_.nu] = g_.tube ? row[0] : 0;
        }
    }
    UNRAVEL_INLINE void make_along(int j) {
        const E* const p = at(j);
        const float* const c = bend_row_of(g_, j, 0);
        const int pitch = g_.pitch;
        for (int i = 0; i < g_.nu; i += Lanes<T>::count) {
            const V3<T> y =
                second(load3<T>(p + i - 1, pitch), load3<T>(p + i, pitch), load3<T>(p + i + 1, pitch));
            store3<T>(along_ + i, pitch, Lanes<T>::load(c + i) * y);
        }
        const int ends[2] = {0, g_.nu - 1};
        for (const int i : ends) {
            if (!g_.tube) break;
            const V3<E> y = second(load3<E>(p + (i + g_.nu - 1) % g_.nu, pitch), load3<E>(p + i, pitch),
                                   load3<E>(p + (i + 1) % g_.nu, pitch));
            store_one(along_ + i, E{c[i]} * y);
        }
        end_row(along_);
    }
    UNRAVEL_INLINE void make_down(int j) {
        E* const out = down(j);
        const int pitch = g_.pitch;
        if (j < 1 || j + 1 >= g_.nv) return clear(out - margin, 3 * pitch);
        const E *const above = at(j - 1), *const p = at(j), *const under = at(j + 1);
        const float* const c = bend_row_of(g_, j, 1);
        for (int i = 0; i < g_.nu; i += Lanes<T>::count) {
            const V3<T> y =
                second(load3<T>(above + i, pitch), load3<T>(p + i, pitch), load3<T>(under + i, pitch));
            store3<T>(out + i, pitch, Lanes<T>::load(c + i) * y);
        }
    }
    UNRAVEL_INLINE void make_twist(int j) {
        E* const out = twist(j);
        const int pitch = g_.pitch;
        if (j < 0 || j + 1 >= g_.nv) return clear(out - margin, 3 * pitch);
        const E *const p = at(j), *const under = at(j + 1);
        const float* const c = bend_row_of(g_, j, 2);
        for (int i = 0; i < g_.nu; i += Lanes<T>::count) {
            const V3<T> y = (load3<T>(p + i, pitch) - load3<T>(p + i + 1, pitch)) -
                            (load3<T>(under + i, pitch) - load3<T>(under + i + 1, pitch));
            store3<T>(out + i, pitch, Lanes<T>::load(c + i) * y);
        }
        if (g_.tube) {
            const int i = g_.nu - 1;
            const V3<E> y = (load3<E>(p + i, pitch) - load3<E>(p, pitch)) -
                            (load3<E>(under + i, pitch) - load3<E>(under, pitch));
            store_one(out + i, E{c[i]} * y);
        }
        end_row(out);
    }
    UNRAVEL_INLINE void store_one(E* to, V3<E> v) const {
        to[0] = v.x;
        to[g_.pitch] = v.y;
        to[2 * g_.pitch] = v.z;
    }

    const StencilGrid& g_;
    const E* p_;
    E *along_, *down_[3], *twist_[2];
};

UNRAVEL_INLINE double lanes_sum(const double (&lanes)[8]) {
    return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

void add_bent(const StencilGrid& g, int begin, int end, const float* p, float* q, double* dots,
              float* scratch) {
    BentRows<f8> rows(g, p, scratch, begin);
    float* const out = scratch + BentRows<f8>::scratch_rows * g.pitch + margin;
    for (int j = begin; j < end; ++j) {
        // Directions lie within the free ones and are zero beside the grid: what is filtered out adds
        // nothing.
        double lanes[8] = {};
        rows.row(j, [&](int i, V3<f8> pv, V3<f8> bent) {
            store3<f8>(out + i, g.pitch, bent);
            const f8 product = dot(pv, bent);
            for (int k = 0; k < 8; ++k) lanes[k] += static_cast<double>(product[k]);
        });
        filter_row(g, j, out);
        float* const qj = row_of(q, g, j, 3);
        for (int i = 0; i < g.nu; i += 8)
            store3<f8>(qj + i, g.pitch, load3<f8>(qj + i, g.pitch) + load3<f8>(out + i, g.pitch));
        dots[j] += lanes_sum(lanes);
    }
}

void take_bent(const StencilGrid& g, int begin, int end, const float* z, float* t, float* scratch) {
    BentRows<f8> rows(g, z, scratch, begin);
    float* const out = scratch + BentRows<f8>::scratch_rows * g.pitch + margin;
    for (int j = begin; j < end; ++j) {
        rows.row(j, [&](int i, V3<f8>, V3<f8> bent) { store3<f8>(out + i, g.pitch, bent); });
        filter_row(g, j, out);
        float* const tj = row_of(t, g, j, 3);
        for (int i = 0; i < g.nu; i += 8)
            store3<f8>(tj + i, g.pitch, load3<f8>(tj + i, g.pitch) - load3<f8>(out + i, g.pitch));
    }
}

void take_bent_in_double(const StencilGrid& g, int begin, int end, const double* b, const double* x,
                         double* out, double* scratch) {
    BentRows<d4> rows(g, x, scratch, begin);
    for (int j = begin; j < end; ++j) {
        const double* const bj = row_of(b, g, j, 3);
        double* const to = row_of(out, g, j, 3);
        rows.row(j, [&](int i, V3<d4>, V3<d4> bent) {
            store3<d4>(to + i, g.pitch, load3<d4>(bj + i, g.pitch) - bent);
        });
    }
}

// Sum over the stencils of a node of c w_k², or of what half of c |w_k| Σ |w| is beyond that.
template <bool beyond>
void bend_diagonal(const StencilGrid& g, int begin, int end, float* D) {
    const int pitch = g.pitch;
    for (int j = begin; j < end; ++j) {
        const int above = j > 0 ? j - 1 : 0, below = j + 1 < g.nv ? j + 1 : j;
        const float* const u = bend_row_of(g, j, 0);
        const float *const v = bend_row_of(g, j, 1), *const v_above = bend_row_of(g, above, 1),
                           *const v_below = bend_row_of(g, below, 1);
        const float *const w = bend_row_of(g, j, 2), *const w_above = bend_row_of(g, above, 2);
        float* const out = row_of(D, g, j, 6);
        const auto add_at = [&]<typename T>(T, int i, int left, int right) {
            const auto of = [&](const float* from, int k) { return Lanes<T>::load(from + k); };
            const T up = j > 0 ? of(v_above, i) : T{}, down = j + 1 < g.nv ? of(v_below, i) : T{};
            T sum = (of(u, left) + of(u, right)) + (up + down) + (of(w, i) + of(w, left));
            if (j > 0) sum = sum + (of(w_above, i) + of(w_above, left));
            if constexpr (!beyond) {
                const T middle = of(u, i) + of(v, i), twice = middle + middle;
                sum = sum + (twice + twice);
            }
            return sum;
        };
        const auto add_to = [&](float* at, float more) {
            for (const int k : on_trace) at[k * pitch] += more;
        };
        if (g.tube) {
            // The ends apart: their neighbours are at the other one.
            for (int i = 0; i < g.nu; ++i)
                add_to(out + i, add_at(0.0f, i, (i + g.nu - 1) % g.nu, (i + 1) % g.nu));
            continue;
        }
        for (int i = 0; i < g.nu; i += 8) {
            const f8 more = add_at(f8{}, i, i - 1, i + 1);
            for (const int k : on_trace) {
                float* const at = out + k * pitch + i;
                Lanes<f8>::store(at, Lanes<f8>::load(at) + more);
            }
        }
    }
}

// One stencil of a fine grid: its nodes, and what holds those that move.
struct Bend {
    float c;
    int count, i[4], j[4];
    float w[4];
};

// What stencils with masked nodes hold a node of row j with: of a shift of all that move of one, c (Σ w)²
// over the masked ones, shared by weight.
UNRAVEL_INLINE float held_by_bends(const StencilGrid& g, int i, int j) {
    const auto masked = [&](int a, int b) {
        const int column = g.tube ? (a + g.nu) % g.nu : a;
        return row_of(g.slot, g, b, 1)[column] == masked_slot;
    };
    const auto c_of = [&](int a, int b, int which) {
        if (b < 0 || b >= g.nv || (!g.tube && (a < 0 || a >= g.nu))) return 0.0f;
        return bend_row_of(g, b, which)[g.tube ? (a + g.nu) % g.nu : a];
    };
    float sum = 0;
    const auto add_of = [&](const Bend& bend, float own) {
        if (bend.c == 0) return;
        float held = 0, moving = 0;
        for (int k = 0; k < bend.count; ++k) {
            if (masked(bend.i[k], bend.j[k]))
                held += bend.w[k];
            else
                moving += bend.w[k] < 0 ? -bend.w[k] : bend.w[k];
        }
        sum += bend.c * held * held * own / moving;
    };
    for (int d = -1; d <= 1; ++d) {
        const float own = d == 0 ? 2.0f : 1.0f;
        add_of({c_of(i + d, j, 0), 3, {i + d - 1, i + d, i + d + 1, 0}, {j, j, j, 0}, {1, -2, 1, 0}}, own);
        add_of({c_of(i, j + d, 1), 3, {i, i, i, 0}, {j + d - 1, j + d, j + d + 1, 0}, {1, -2, 1, 0}}, own);
    }
    for (int a = i - 1; a <= i; ++a) {
        for (int b = j - 1; b <= j; ++b)
            add_of({c_of(a, b, 2), 4, {a, a + 1, a + 1, a}, {b, b, b + 1, b + 1}, {1, -1, 1, -1}}, 1.0f);
    }
    return sum;
}

void coarsen_bends(const StencilGrid& g, const StencilGrid& coarse, int begin, int end, float* bends,
                   float* self) {
    const auto free_near = [&](int j) {
        for (int b = j > 2 ? j - 2 : 0; b <= j + 2 && b < g.nv; ++b) {
            const std::int32_t* const slot = row_of(g.slot, g, b, 1);
            for (int i = 0; i < g.nu; ++i)
                if (slot[i] == masked_slot) return false;
        }
        return true;
    };
    for (int J = begin; J < end; ++J) {
        const int j = 2 * J, last = j + 1 < g.nv ? j + 1 : j;
        for (int which = 0; which < 3; ++which) {
            float* const out = row_of(bends, coarse, J, 3) + which * coarse.pitch;
            const int reach_u = which == 1 ? 0 : 1, reach_v = which == 0 ? 0 : 1;
            for (int I = 0; I < coarse.nu; ++I) {
                // A twist's cell goes to the right and down; a line goes both ways.
                const bool beside = !coarse.tube && ((which == 0 && I == 0) || I + reach_u >= coarse.nu);
                const bool beyond = (which == 1 && J == 0) || J + reach_v >= coarse.nv;
                out[I] = 0;
                if (beside || beyond) continue;
                for (int b = j; b <= last; ++b) {
                    const float* const c = bend_row_of(g, b, which) + 2 * I;
                    out[I] += 0.0625f * (c[0] + (2 * I + 1 < g.nu ? c[1] : 0.0f));
                }
            }
        }
        for (int b = j; b <= last; ++b) {
            if (free_near(b)) continue;
            const std::int32_t* const slot = row_of(g.slot, g, b, 1);
            for (int i = 0; i < g.nu; ++i) {
                if (slot[i] == masked_slot) continue;
                const float held = held_by_bends(g, i, b);
                float* const to = row_of(self, coarse, J, 6) + i / 2;
                for (const int k : on_trace) to[k * coarse.pitch] += held;
            }
        }
    }
}

}  // namespace

extern const BendKernels bend_kernels;
const BendKernels bend_kernels = {
    add_bent, take_bent, take_bent_in_double, {bend_diagonal<false>, bend_diagonal<true>}, coarsen_bends,
};

}  // namespace unravel::sim::UNRAVEL_ISA
