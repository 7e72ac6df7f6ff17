#include "sim/rows/couple_row.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sim/rows/row_strips.hpp"

namespace unravel::sim {

UNRAVEL_VERSIONS double couple_row(const RowEnd& a, const RowEnd& b, double rest, const double* stiffness,
                                   const double* damping, const SpringState* state, const double* arcs,
                                   double h, std::size_t count, const Row& fa, const Row& fb, float* blocks,
                                   std::ptrdiff_t pitch) {
    double force[3][strip], of_arc[strip] = {};
    float block[4][strip], square[strip], lightest[strip];
    std::int64_t implicit[strip];
    const auto [ax, ay, az] = a.x;
    const auto [bx, by, bz] = b.x;
    const auto [au, av, aw] = a.drift;
    const auto [bu, bv, bw] = b.drift;
    const double hh = h * h;
    std::int32_t stiffest = 0;  // the bits of what is not negative are in the numbers' order
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        std::int64_t any = 0;
        for (std::size_t k = 0; k < n; ++k) {
            implicit[k] = state[first + k] == SpringState::implicit;
            any |= implicit[k];
        }
        if (arcs) {
            for (std::size_t k = 0; k < n; ++k) {
                of_arc[k] = arcs[first + k];
                any |= of_arc[k] != 0;
            }
        }
        if (any == 0) {
            for (std::ptrdiff_t c = 0; blocks && c < 4; ++c) std::fill_n(blocks + c * pitch + first, n, 0.0f);
            continue;
        }
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k;
            const double dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
            const double squared = std::max(dx * dx + dy * dy + dz * dz, least_square);
            const double r = inverse_root(squared);
            const double ux = dx * r, uy = dy * r, uz = dz * r;
            const double of_ours = a.ours[i] + b.ours[i] > 0 ? 1.0 : 0.0;
            const double on = implicit[k] != 0 ? of_ours : 0.0;
            const double t = transverse_stiffness(on * stiffness[i], rest * r);
            const double along = on * stiffness[i] - t + of_ours * of_arc[k];
            const double scale = hh * along + h * on * damping[i];
            block[0][k] = static_cast<float>(hh * t);
            block[1][k] = static_cast<float>(ux);
            block[2][k] = static_cast<float>(uy);
            block[3][k] = static_cast<float>(uz);
            square[k] = static_cast<float>(scale);
            lightest[k] = static_cast<float>(std::min(a.mass[i], b.mass[i]));
            const double gx = bu[i] - au[i], gy = bv[i] - av[i], gz = bw[i] - aw[i];
            const double stretch = along * (ux * gx + uy * gy + uz * gz);
            force[0][k] = h * (t * gx + stretch * ux);
            force[1][k] = h * (t * gy + stretch * uy);
            force[2][k] = h * (t * gz + stretch * uz);
        }
        // What is kept in single precision is also computed in it.
        for (std::size_t k = 0; k < n; ++k) {
            const float root = std::sqrt(square[k]);
            const float coupling = (block[0][k] + square[k]) / lightest[k];
            stiffest = std::max(stiffest, std::bit_cast<std::int32_t>(coupling));
            block[1][k] *= root;
            block[2][k] *= root;
            block[3][k] *= root;
        }
        if (blocks) {
            for (std::ptrdiff_t c = 0; c < 4; ++c) std::copy_n(block[c], n, blocks + c * pitch + first);
        }
        hand_on(force, first, n, fa, fb);
    }
    return static_cast<double>(std::bit_cast<float>(stiffest));
}

}  // namespace unravel::sim
