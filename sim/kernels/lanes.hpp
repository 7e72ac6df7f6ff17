#pragma once

// Arithmetic on lanes, for the kernels alone: everything here is inlined into them, so that each build of a
// kernel (sim/kernels/stencil_kernels.hpp) holds its own copy and no instruction that its machine lacks. Only
// additions, multiplications, divisions and moves are used, never fused, so every build gives the same bits.

#include <cstdint>

#define UNRAVEL_INLINE __attribute__((always_inline)) inline

namespace unravel::sim {

using f8 = float __attribute__((vector_size(32)));
using d4 = double __attribute__((vector_size(32)));
using f8_at_any = float __attribute__((vector_size(32), aligned(4), may_alias));
using f4_at_any = float __attribute__((vector_size(16), aligned(4), may_alias));
using d4_at_any = double __attribute__((vector_size(32), aligned(8), may_alias));

// Lanes of T: how many, of what, read and written where, and moved up by one lane.
template <typename T>
struct Lanes;

template <>
struct Lanes<f8> {
    using Element = float;
    static constexpr int count = 8;
    static UNRAVEL_INLINE f8 load(const float* p) { return *reinterpret_cast<const f8_at_any*>(p); }
    static UNRAVEL_INLINE void store(float* p, f8 v) { *reinterpret_cast<f8_at_any*>(p) = v; }
    static UNRAVEL_INLINE f8 shifted(f8 before, f8 v) {
        return __builtin_shufflevector(before, v, 7, 8, 9, 10, 11, 12, 13, 14);
    }
};

template <>
struct Lanes<d4> {
    using Element = double;
    static constexpr int count = 4;
    static UNRAVEL_INLINE d4 load(const double* p) { return *reinterpret_cast<const d4_at_any*>(p); }
    static UNRAVEL_INLINE d4 load(const float* p) {
        return __builtin_convertvector(*reinterpret_cast<const f4_at_any*>(p), d4);
    }
    static UNRAVEL_INLINE void store(double* p, d4 v) { *reinterpret_cast<d4_at_any*>(p) = v; }
    static UNRAVEL_INLINE void store(float* p, d4 v) {
        using f4 = float __attribute__((vector_size(16)));
        *reinterpret_cast<f4_at_any*>(p) = __builtin_convertvector(v, f4);
    }
    static UNRAVEL_INLINE d4 shifted(d4 before, d4 v) {
        return __builtin_shufflevector(before, v, 3, 4, 5, 6);
    }
};

// One lane: where a tube closes.
template <>
struct Lanes<float> {
    using Element = float;
    static UNRAVEL_INLINE float load(const float* p) { return *p; }
};
template <>
struct Lanes<double> {
    using Element = double;
    static UNRAVEL_INLINE double load(const float* p) { return *p; }
    static UNRAVEL_INLINE double load(const double* p) { return *p; }
};

// A 3-vector per lane.
template <typename T>
struct V3 {
    T x, y, z;
};
template <typename T>
UNRAVEL_INLINE V3<T> operator+(V3<T> a, V3<T> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
UNRAVEL_INLINE V3<T> operator-(V3<T> a, V3<T> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
UNRAVEL_INLINE V3<T> operator*(T s, V3<T> a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <typename T>
UNRAVEL_INLINE T dot(V3<T> a, V3<T> b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
// Components of a vector stand `pitch` apart.
template <typename T, typename E>
UNRAVEL_INLINE V3<T> load3(const E* p, int pitch) {
    return {Lanes<T>::load(p), Lanes<T>::load(p + pitch), Lanes<T>::load(p + 2 * pitch)};
}
template <typename T, typename E>
UNRAVEL_INLINE void store3(E* p, int pitch, V3<T> v) {
    Lanes<T>::store(p, v.x);
    Lanes<T>::store(p + pitch, v.y);
    Lanes<T>::store(p + 2 * pitch, v.z);
}
template <typename T>
UNRAVEL_INLINE V3<T> shifted(V3<T> before, V3<T> v) {
    return {Lanes<T>::shifted(before.x, v.x), Lanes<T>::shifted(before.y, v.y),
            Lanes<T>::shifted(before.z, v.z)};
}

// A symmetric 3 × 3 block per lane.
template <typename T>
struct Sym3 {
    T xx, xy, xz, yy, yz, zz;
};
template <typename T>
UNRAVEL_INLINE V3<T> operator*(Sym3<T> m, V3<T> v) {
    return {(m.xx * v.x + m.xy * v.y) + m.xz * v.z, (m.xy * v.x + m.yy * v.y) + m.yz * v.z,
            (m.xz * v.x + m.yz * v.y) + m.zz * v.z};
}
template <typename T>
UNRAVEL_INLINE Sym3<T> operator+(Sym3<T> a, Sym3<T> b) {
    return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
template <typename T>
UNRAVEL_INLINE Sym3<T> operator-(Sym3<T> a, Sym3<T> b) {
    return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz};
}
template <typename T, typename E>
UNRAVEL_INLINE Sym3<T> load6(const E* p, int pitch) {
    return {Lanes<T>::load(p),
            Lanes<T>::load(p + pitch),
            Lanes<T>::load(p + 2 * pitch),
            Lanes<T>::load(p + 3 * pitch),
            Lanes<T>::load(p + 4 * pitch),
            Lanes<T>::load(p + 5 * pitch)};
}
template <typename T, typename E>
UNRAVEL_INLINE void store6(E* p, int pitch, Sym3<T> m) {
    Lanes<T>::store(p, m.xx);
    Lanes<T>::store(p + pitch, m.xy);
    Lanes<T>::store(p + 2 * pitch, m.xz);
    Lanes<T>::store(p + 3 * pitch, m.yy);
    Lanes<T>::store(p + 4 * pitch, m.yz);
    Lanes<T>::store(p + 5 * pitch, m.zz);
}
// By cofactors. The matrix must be invertible in every lane.
template <typename T>
UNRAVEL_INLINE Sym3<T> inverse(Sym3<T> m) {
    const T cxx = m.yy * m.zz - m.yz * m.yz, cxy = m.xz * m.yz - m.xy * m.zz, cxz = m.xy * m.yz - m.xz * m.yy;
    const T scale = 1.0 / ((m.xx * cxx + m.xy * cxy) + m.xz * cxz);
    return {scale * cxx,
            scale * cxy,
            scale * cxz,
            scale * (m.xx * m.zz - m.xz * m.xz),
            scale * (m.xy * m.xz - m.xx * m.yz),
            scale * (m.xx * m.yy - m.xy * m.xy)};
}

// What joins two particles. A spring: a I + w wᵀ, four numbers.
template <typename T>
struct SpringBlock {
    T a;
    V3<T> w;
};
template <typename T>
UNRAVEL_INLINE V3<T> operator*(SpringBlock<T> s, V3<T> v) {
    return s.a * v + dot(s.w, v) * s.w;
}
template <typename T>
UNRAVEL_INLINE Sym3<T> as_matrix(SpringBlock<T> s) {
    const V3<T> w = s.w;
    return {s.a + w.x * w.x, w.x * w.y, w.x * w.z, s.a + w.y * w.y, w.y * w.z, s.a + w.z * w.z};
}
template <typename T>
UNRAVEL_INLINE Sym3<T> as_matrix(Sym3<T> s) {
    return s;
}

// B E B, both symmetric.
template <typename T>
UNRAVEL_INLINE Sym3<T> sandwiched(Sym3<T> b, Sym3<T> e) {
    const V3<T> cx = e * V3<T>{b.xx, b.xy, b.xz}, cy = e * V3<T>{b.xy, b.yy, b.yz},
                cz = e * V3<T>{b.xz, b.yz, b.zz};  // columns of E B
    const V3<T> x{b.xx, b.xy, b.xz}, y{b.xy, b.yy, b.yz}, z{b.xz, b.yz, b.zz};
    return {dot(x, cx), dot(x, cy), dot(x, cz), dot(y, cy), dot(y, cz), dot(z, cz)};
}

/// Kinds of blocks between neighbours as they lie in memory: on the grid itself, and on coarser ones.
struct Springs {
    static constexpr int numbers = 4;
    template <typename T, typename E>
    static UNRAVEL_INLINE SpringBlock<T> load(const E* p, int pitch) {
        return {Lanes<T>::load(p), load3<T>(p + pitch, pitch)};
    }
};
struct Blocks {
    static constexpr int numbers = 6;
    template <typename T, typename E>
    static UNRAVEL_INLINE Sym3<T> load(const E* p, int pitch) {
        return load6<T>(p, pitch);
    }
};

// Rows of eight become columns of eight.
UNRAVEL_INLINE void transpose(f8 (&r)[8]) {
    f8 t[8];
    for (int k = 0; k < 8; k += 2) {
        t[k] = __builtin_shufflevector(r[k], r[k + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        t[k + 1] = __builtin_shufflevector(r[k], r[k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    f8 s[8];
    for (int k = 0; k < 8; k += 4) {
        s[k] = __builtin_shufflevector(t[k], t[k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
        s[k + 1] = __builtin_shufflevector(t[k], t[k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        s[k + 2] = __builtin_shufflevector(t[k + 1], t[k + 3], 0, 1, 8, 9, 4, 5, 12, 13);
        s[k + 3] = __builtin_shufflevector(t[k + 1], t[k + 3], 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (int k = 0; k < 4; ++k) {
        r[k] = __builtin_shufflevector(s[k], s[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        r[k + 4] = __builtin_shufflevector(s[k], s[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

}  // namespace unravel::sim
