#pragma once

// What kernels that work along rows share, inlined into each of them.

#include <cmath>
#include <cstddef>

#include "sim/rows/sweep_row.hpp"
#include "sim/rows/versions.hpp"

namespace unravel::sim {

// Springs evaluated before their forces are handed on: small enough for the forces to stay in the first
// cache.
inline constexpr std::size_t strip = 64;

// Below any distance that matters [m²]: coincident ends get a direction of zero instead of none.
inline constexpr double least_square = 1e-30;

// 1/√s. A square root and a division in double take most of a spring's time; in single precision, where eight
// fit, they are a seed, and one Newton step, r (3 − s r²)/2 of error 3/2 (1e-7)², makes it good to 2e-14.
UNRAVEL_INLINE double inverse_root(double s) {
    const double seed = 1.0f / std::sqrt(static_cast<float>(s));
    return seed * (1.5 - 0.5 * s * (seed * seed));
}

// Forces of a strip, to one end and back to the other. Two loops, because within a row the ends overlap.
UNRAVEL_INLINE void hand_on(const double (&force)[3][strip], std::size_t first, std::size_t count,
                            const Row& fa, const Row& fb) {
    for (int c = 0; c < 3; ++c) {
        double* const a = fa[static_cast<std::size_t>(c)] + first;
        double* const b = fb[static_cast<std::size_t>(c)] + first;
        for (std::size_t i = 0; i < count; ++i) a[i] += force[c][i];
        for (std::size_t i = 0; i < count; ++i) b[i] -= force[c][i];
    }
}

}  // namespace unravel::sim
