#pragma once

// What the kernels share, inlined into each of them. Only for files that are compiled once per instruction
// set.

#include <cstddef>

#include "sim/kernels/lanes.hpp"
#include "sim/kernels/stencil_kernels.hpp"

namespace unravel::sim {

constexpr int margin = StencilGrid::margin;

// Row j of a field of c numbers per node, at its column 0.
template <typename E>
UNRAVEL_INLINE E* row_of(E* field, const StencilGrid& g, int j, int c) {
    return field + static_cast<std::ptrdiff_t>(j) * c * g.pitch + margin;
}

// What a node has for itself.
struct Mass {
    static constexpr int numbers = 1;
    template <typename T>
    static UNRAVEL_INLINE V3<T> times(const float* self, int, V3<T> p) {
        return Lanes<T>::load(self) * p;
    }
    template <typename T>
    static UNRAVEL_INLINE Sym3<T> block(const float* self, int) {
        const T m = Lanes<T>::load(self), zero{};
        return {m, zero, zero, m, zero, m};
    }
};
struct OwnBlock {
    static constexpr int numbers = 6;
    template <typename T>
    static UNRAVEL_INLINE V3<T> times(const float* self, int pitch, V3<T> p) {
        return load6<T>(self, pitch) * p;
    }
    template <typename T>
    static UNRAVEL_INLINE Sym3<T> block(const float* self, int pitch) {
        return load6<T>(self, pitch);
    }
};

// Fine: springs and masses. Coarse: blocks.
struct Fine {
    using Coupling = Springs;
    using Self = Mass;
};
struct Coarse {
    using Coupling = Blocks;
    using Self = OwnBlock;
};

template <typename Level>
struct CouplingRows {
    const float *u, *v, *diagonal, *anti;
    UNRAVEL_INLINE CouplingRows(const StencilGrid& g, int j) {
        constexpr int c = Level::Coupling::numbers;
        u = row_of(g.couplings, g, j, 4 * c);
        v = u + c * g.pitch;
        diagonal = v + c * g.pitch;
        anti = diagonal + c * g.pitch;
    }
};

// The columns beside the grid, where a tube closes.
template <typename E>
UNRAVEL_INLINE void close_ring(E* row, const StencilGrid& g, int numbers) {
    if (!g.tube) return;
    for (int k = 0; k < numbers; ++k, row += g.pitch) {
        row[-1] = row[g.nu - 1];
        row[g.nu] = row[0];
    }
}
template <typename E>
UNRAVEL_INLINE void open_ring(E* row, const StencilGrid& g, int numbers) {
    if (!g.tube) return;
    for (int k = 0; k < numbers; ++k, row += g.pitch) row[-1] = row[g.nu] = 0;
}

template <typename T>
UNRAVEL_INLINE void clear(T* p, std::ptrdiff_t count) {
    for (std::ptrdiff_t k = 0; k < count; ++k) p[k] = 0;
}

// S y for the partly constrained nodes of a row, 0 for the masked ones.
UNRAVEL_INLINE void filter_row(const StencilGrid& g, int j, float* y) {
    const std::int32_t* const slot = row_of(g.slot, g, j, 1);
    // Past the last column, too: what flows out of a tube there comes in again at the first.
    for (int i = 0; i < g.columns(); i += 4) {
        if (slot[i] == free_slot && slot[i + 1] == free_slot && slot[i + 2] == free_slot &&
            slot[i + 3] == free_slot)
            continue;
        for (int k = i; k < i + 4; ++k) {
            if (slot[k] == free_slot) continue;
            float *const x = y + k, *const yy = x + g.pitch, *const z = yy + g.pitch;
            if (slot[k] == masked_slot || !g.directions) {
                *x = *yy = *z = 0;
                continue;
            }
            const double* const t = g.directions + 6 * slot[k];
            const double a = t[0] * *x + t[1] * *yy + t[2] * *z, b = t[3] * *x + t[4] * *yy + t[5] * *z;
            *x = static_cast<float>(a * t[0] + b * t[3]);
            *yy = static_cast<float>(a * t[1] + b * t[4]);
            *z = static_cast<float>(a * t[2] + b * t[5]);
        }
    }
}

// D⁻¹ within the free directions of one node: T (Tᵀ D T)⁻¹ Tᵀ, the columns of T the directions.
UNRAVEL_INLINE Sym3<double> inverse_within(Sym3<double> D, const double* t) {
    const V3<double> a{t[0], t[1], t[2]}, b{t[3], t[4], t[5]};
    const V3<double> Da = D * a, Db = D * b;
    const double aa = dot(a, Da), ab = dot(a, Db), bb = dot(b, Db);
    double saa, sab = 0, sbb = 0;
    if (bb > 0) {
        const double scale = 1.0 / (aa * bb - ab * ab);
        saa = scale * bb;
        sab = -scale * ab;
        sbb = scale * aa;
    } else {
        saa = 1.0 / aa;
    }
    const V3<double> p = saa * a + sab * b, q = sab * a + sbb * b;
    return {p.x * a.x + q.x * b.x, p.x * a.y + q.x * b.y, p.x * a.z + q.x * b.z,
            p.y * a.y + q.y * b.y, p.y * a.z + q.y * b.z, p.z * a.z + q.z * b.z};
}

// Four nodes' D⁻¹, each within its free directions; 0 where masked. slot[k·stride] belongs to lane k.
UNRAVEL_INLINE Sym3<d4> inverse_of(const StencilGrid& g, Sym3<d4> D, const std::int32_t* slot,
                                   std::ptrdiff_t stride) {
    const std::int32_t s[4] = {slot[0], slot[stride], slot[2 * stride], slot[3 * stride]};
    if ((s[0] & s[1] & s[2] & s[3]) == free_slot) return inverse(D);
    Sym3<d4> m = D;
    for (int k = 0; k < 4; ++k) {
        Sym3<double> one{0, 0, 0, 0, 0, 0};
        const Sym3<double> Dk{D.xx[k], D.xy[k], D.xz[k], D.yy[k], D.yz[k], D.zz[k]};
        if (s[k] == free_slot) one = inverse(Dk);
        if (s[k] >= 0) one = inverse_within(Dk, g.directions + 6 * s[k]);
        m.xx[k] = one.xx, m.xy[k] = one.xy, m.xz[k] = one.xz;
        m.yy[k] = one.yy, m.yz[k] = one.yz, m.zz[k] = one.zz;
    }
    return m;
}

}  // namespace unravel::sim
