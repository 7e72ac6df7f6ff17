#include "sim/rows/sweep_row.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "sim/forces/air_law.hpp"
#include "sim/forces/bend.hpp"
#include "sim/rows/row_strips.hpp"

namespace unravel::sim {

UNRAVEL_VERSIONS void extension_row(const RowState& a, const RowState& b, double rest,
                                    const double* stiffness, const double* damping, std::size_t count,
                                    const Row& fa, const Row& fb) {
    double force[3][strip];
    const auto [ax, ay, az] = a.x;
    const auto [bx, by, bz] = b.x;
    const auto [au, av, aw] = a.v;
    const auto [bu, bv, bw] = b.v;
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k;
            const double dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
            const double squared = std::max(dx * dx + dy * dy + dz * dz, least_square);
            const double r = inverse_root(squared), length = squared * r;
            const double rate = (dx * (bu[i] - au[i]) + dy * (bv[i] - av[i]) + dz * (bw[i] - aw[i])) * r;
            const double pull = spring_pull(stiffness[i], length - rest, damping[i], rate).sum() * r;
            const double t = is_taut(length, rest) ? pull : 0.0;
            force[0][k] = t * dx;
            force[1][k] = t * dy;
            force[2][k] = t * dz;
        }
        hand_on(force, first, n, fa, fb);
    }
}

UNRAVEL_VERSIONS void split_row(const RowState& a, const RowState& b, double rest, const double* stiffness,
                                const double* damping, const double* is_explicit, const std::uint8_t* taut,
                                double reach, std::size_t count, const Row& fa, const Row& fb,
                                SpringState* state) {
    double force[3][strip];
    std::int64_t will_be_taut[strip] = {}, kind[strip];
    const auto [ax, ay, az] = a.x;
    const auto [bx, by, bz] = b.x;
    const auto [au, av, aw] = a.v;
    const auto [bu, bv, bw] = b.v;
    const double taut_squared = rest * rest, reach_squared = reach * reach;
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        if (taut) {
            for (std::size_t k = 0; k < n; ++k) will_be_taut[k] = taut[first + k];
        }
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k;
            const double dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
            const double exact = dx * dx + dy * dy + dz * dz;
            const double squared = std::max(exact, least_square);
            const double r = inverse_root(squared);
            const double rate = (dx * (bu[i] - au[i]) + dy * (bv[i] - av[i]) + dz * (bw[i] - aw[i])) * r;
            const double pull = spring_pull(stiffness[i], squared * r - rest, damping[i], rate).sum() * r;
            const bool reached = (exact > reach_squared) | ((will_be_taut[k] == 2) & (exact > 0));
            const SpringSplit split{is_explicit[i] > 0, is_taut(exact, taut_squared), reached,
                                    will_be_taut[k] == 1, exact > 0};
            const double t = split.pulls() ? pull : 0.0;
            force[0][k] = t * dx;
            force[1][k] = t * dy;
            force[2][k] = t * dz;
            kind[k] = split.code();
        }
        if (state) {
            for (std::size_t k = 0; k < n; ++k) state[first + k] = static_cast<SpringState>(kind[k]);
        }
        hand_on(force, first, n, fa, fb);
    }
}

UNRAVEL_VERSIONS void mark_row(const ConstRow& a, const ConstRow& b, double rest, std::size_t count,
                               std::uint8_t* taut) {
    const auto [ax, ay, az] = a;
    const auto [bx, by, bz] = b;
    const double taut_squared = rest * rest;
    std::int64_t longer[strip];
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k;
            const double dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
            longer[k] = is_taut(dx * dx + dy * dy + dz * dz, taut_squared);
        }
        for (std::size_t k = 0; k < n; ++k) taut[first + k] = static_cast<std::uint8_t>(longer[k]);
    }
}

UNRAVEL_VERSIONS void bend_row(const RowState& a, const RowState& b, double rest, const double* arc,
                               const double* slope, const double* crossing, std::size_t count, const Row& fa,
                               const Row& fb) {
    double force[3][strip], length[strip];
    const auto [ax, ay, az] = a.x;
    const auto [bx, by, bz] = b.x;
    const double inverse_rest = 1.0 / rest;
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        // Taut cloth doesn't buckle, and most that does is still on the straight part of its push.
        std::int64_t compressed = 0, deep = 0;
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k;
            const double dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
            const double squared = std::max(dx * dx + dy * dy + dz * dz, least_square);
            const double r = inverse_root(squared);
            const double l = squared * r;
            const double push = l < rest ? straight_push(slope[i], l, rest) * r : 0.0;
            compressed |= l < rest;
            deep |= l < crossing[i];
            length[k] = l;
            force[0][k] = push * dx;
            force[1][k] = push * dy;
            force[2][k] = push * dz;
        }
        if (compressed == 0) continue;
        if (deep != 0) {
            // The arc's push stands to the straight one as their magnitudes.
            for (std::size_t k = 0; k < n; ++k) {
                const std::size_t i = first + k;
                const double l = length[k], straight = straight_push(slope[i], l, rest);
                const double curved = arc_push(arc[i], l * inverse_rest);
                const double share = l < crossing[i] ? curved / straight : 1.0;
                force[0][k] *= share;
                force[1][k] *= share;
                force[2][k] *= share;
            }
        }
        hand_on(force, first, n, fa, fb);
    }
}

UNRAVEL_VERSIONS void curvature_row(std::span<const RowPart> parts, const double* stiffness,
                                    std::size_t count) {
    double pull[strip];
    const bool four = parts.size() == 4;
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        const double* const c = stiffness + first;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = [&](std::size_t k) { return parts[k].x[axis] + first; };
            const double *const a = at(0), *const b = at(1), *const d = at(2), *const e = at(four ? 3 : 0);
            const double wa = parts[0].w, wb = parts[1].w, wd = parts[2].w, we = four ? parts[3].w : 0.0;
            for (std::size_t k = 0; k < n; ++k)
                pull[k] = c[k] * ((wa * a[k] + wd * d[k]) + (wb * b[k] + we * e[k]));
            for (const RowPart& part : parts) {
                double* const f = part.f[axis] + first;
                for (std::size_t k = 0; k < n; ++k) f[k] -= part.w * pull[k];
            }
        }
    }
}

UNRAVEL_VERSIONS void air_row(const RowState& a, const RowState& b, const double* mass_a,
                              const double* mass_b, const RowWind& wind, std::size_t count, const Row& fa,
                              const Row& fb) {
    double force[3][strip];
    const auto [ax, ay, az] = a.x;
    const auto [bx, by, bz] = b.x;
    const auto [au, av, aw] = a.v;
    const auto [bu, bv, bw] = b.v;
    const double wu = wind.velocity.x(), wv = wind.velocity.y(), ww = wind.velocity.z();
    const double inverse_h = 1.0 / wind.h;
    for (std::size_t first = 0; first < count; first += strip) {
        const std::size_t n = std::min(strip, count - first);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k, j = i + 1;
            // The cell's diagonals, from its first corner and from its last.
            const double dx = bx[j] - ax[i], dy = by[j] - ay[i], dz = bz[j] - az[i];
            const double ex = ax[j] - bx[i], ey = ay[j] - by[i], ez = az[j] - bz[i];
            const double nx = 0.5 * (dy * ez - dz * ey), ny = 0.5 * (dz * ex - dx * ez);
            const double nz = 0.5 * (dx * ey - dy * ex);
            const double squared = std::max(nx * nx + ny * ny + nz * nz, least_square);
            const double r = inverse_root(squared), area = squared * r;
            const double ru = wu - 0.25 * (au[i] + bu[i] + bu[j] + au[j]);
            const double rv = wv - 0.25 * (av[i] + bv[i] + bv[j] + av[j]);
            const double rw = ww - 0.25 * (aw[i] + bw[i] + bw[j] + aw[j]);
            const double along = (nx * ru + ny * rv + nz * rw) * r;
            const double lightest = std::min(std::min(mass_a[i], mass_a[j]), std::min(mass_b[i], mass_b[j]));
            const AirPush push =
                air_push(wind, area, along, std::sqrt(ru * ru + rv * rv + rw * rw), lightest * inverse_h);
            const double normal = 0.25 * (push.drag - push.lift) * along * r, across = 0.25 * push.lift;
            force[0][k] = normal * nx + across * ru;
            force[1][k] = normal * ny + across * rv;
            force[2][k] = normal * nz + across * rw;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            for (double* const f : {fa[c] + first, fa[c] + first + 1, fb[c] + first, fb[c] + first + 1}) {
                for (std::size_t k = 0; k < n; ++k) f[k] += force[c][k];
            }
        }
    }
}

UNRAVEL_VERSIONS void advance_row(const Row& x, const Row& v, const Row& f, const double* inverse_mass,
                                  const Vec3& gravity, double h, std::size_t count) {
    for (std::size_t c = 0; c < 3; ++c) {
        double* __restrict const xc = x[c];
        double* __restrict const vc = v[c];
        double* __restrict const fc = f[c];
        const double g = gravity[static_cast<Eigen::Index>(c)];
        for (std::size_t i = 0; i < count; ++i) {
            const double next = vc[i] + h * (g + fc[i] * inverse_mass[i]);
            vc[i] = next;
            xc[i] += h * next;
            fc[i] = 0;
        }
    }
}

UNRAVEL_VERSIONS double largest_squared_speed(const ConstRow& v, std::size_t count) {
    // Bits of numbers that are not negative are in the numbers' order, and all below those of no number.
    std::int64_t largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double squared = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
        largest = std::max(largest, std::bit_cast<std::int64_t>(squared));
    }
    return std::bit_cast<double>(largest);
}

}  // namespace unravel::sim
