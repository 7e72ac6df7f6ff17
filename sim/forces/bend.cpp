#include "sim/forces/bend.hpp"

#include <algorithm>
#include <cmath>

namespace unravel::sim {

double arc_force(double s) {
    return arc_force_within(std::clamp(s, 0.0, 1.0));
}

double arc_energy(double s) {
    // θ² = −∫_s^1 2F ds = −2 Σ c_k u^(k+1)/(k+1)
    const double u = 1.0 - std::clamp(s, 0.0, 1.0);
    double value = 0;
    for (std::size_t k = arc_coefficients.size(); k-- > 0;) {
        value = value * u + arc_coefficients[k] / static_cast<double>(k + 1);
    }
    return -2.0 * value * u;
}

double bend_force(double length, double rest, double stiffness, double slope) {
    if (length >= rest) return 0;
    const double arc = arc_push(4.0 * stiffness / (rest * rest), std::clamp(length / rest, 0.0, 1.0));
    return std::max(arc, straight_push(slope, length, rest));
}

double bend_force_slope(double length, double rest, double stiffness, double slope) {
    if (length >= rest) return 0;
    const double scale = 4.0 * stiffness / (rest * rest);
    if (arc_push(scale, std::clamp(length / rest, 0.0, 1.0)) < straight_push(slope, length, rest))
        return slope;
    // F'(s) = −dF/du
    const double u = 1.0 - std::clamp(length / rest, 0.0, 1.0);
    double value = 0;
    for (std::size_t k = arc_coefficients.size(); k-- > 1;)
        value = value * u - static_cast<double>(k) * arc_coefficients[k];
    return scale / rest * value;
}

double bend_crossing(double rest, double stiffness, double slope) {
    // slope·L·u = −A F(1 − u), A = 4 k_b/L². Both sides are known at u = 0 (0 < 3A); bisection needs no
    // derivative and this runs once per spring and step size.
    const double scale = 4.0 * stiffness / (rest * rest);
    if (slope * rest <= -scale * arc_force(0.0)) return 0;
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
        const double u = 0.5 * (low + high);
        (slope * rest * u < -scale * arc_force(1.0 - u) ? low : high) = u;
    }
    return rest * (1.0 - 0.5 * (low + high));
}

double bend_energy(double length, double rest, double stiffness, double slope, double crossing) {
    if (length >= rest) return 0;
    const double linear = rest - std::max(length, crossing);
    double energy = 0.5 * slope * linear * linear;
    if (length < crossing) {
        energy += 2.0 * stiffness / rest * (arc_energy(length / rest) - arc_energy(crossing / rest));
    }
    return energy;
}

void limit_bend(const BendSprings& springs, std::span<const double> mass, double h, BendLimit& limit) {
    if (limit.h == h && limit.slope.size() == springs.size()) return;
    limit.h = h;
    std::vector<double>&slope = limit.slope.own(), &crossing = limit.crossing.own();
    slope.resize(springs.size());
    crossing.resize(springs.size());
    parallel_chunks(springs.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const double bound =
                bend_slope_limit * std::min(mass[springs.i[s]], mass[springs.j[s]]) / (h * h);
            slope[s] = std::min(springs.slope[s], bound);
            // On a grid nearly every spring is like the one before it.
            const bool same = s > begin && springs.rest[s] == springs.rest[s - 1] &&
                              springs.stiffness[s] == springs.stiffness[s - 1] && slope[s] == slope[s - 1];
            crossing[s] =
                same ? crossing[s - 1] : bend_crossing(springs.rest[s], springs.stiffness[s], slope[s]);
        }
    });
    limit.limited = 0;
    for (std::size_t s = 0; s < springs.size(); ++s) limit.limited += slope[s] < springs.slope[s];
    limit.slope.code();
    limit.crossing.code();
}

void bend_forces(const BendSprings& springs, const BendLimit& limit, std::span<const Vec3> x,
                 std::span<Vec3> force) {
    parallel_each(springs.size(), [&](std::size_t s) {
        const Vec3 d = x[springs.j[s]] - x[springs.i[s]];
        const double squared = d.squaredNorm(), rest = springs.rest[s];
        // Coincident ends have no direction to push along: no force until something else parts them.
        if (squared >= rest * rest || squared == 0) {
            force[s].setZero();
            return;
        }
        const double length = std::sqrt(squared);
        force[s] = bend_force(length, rest, springs.stiffness[s], limit.slope[s]) / length * d;
    });
}

void bend_jacobians(const BendSprings& springs, const BendLimit& limit, std::span<const Vec3> x,
                    ImplicitBend& out) {
    if (out.springs.size() != springs.size()) {
        out.springs.i = springs.i;
        out.springs.j = springs.j;
        out.springs.rest = springs.rest;
        out.springs.stiffness.own().assign(springs.size(), 0.0);
        out.springs.damping.own().assign(springs.size(), 0.0);
        out.springs.stretch_count = 0;
        out.forces.resize(springs.size());
    }
    bend_forces(springs, limit, x, out.forces.force);
    std::vector<double>& stiffness = out.springs.stiffness.own();
    parallel_each(springs.size(), [&](std::size_t s) {
        out.forces.transverse[s] = 0;
        out.forces.state[s] = SpringState::inactive;
        stiffness[s] = 0;
        if (out.forces.force[s].isZero(0)) return;
        const Vec3 d = x[springs.j[s]] - x[springs.i[s]];
        const double length = d.norm();
        out.forces.direction[s] = d / length;
        out.forces.state[s] = SpringState::implicit;
        stiffness[s] = bend_force_slope(length, springs.rest[s], springs.stiffness[s], limit.slope[s]);
    });
}

}  // namespace unravel::sim
