#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/extension.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Bend springs after Choi & Ko, "Stable but responsive cloth" (2002), Sec. 4.2. Where the strip between its
/// ends is shorter than flat, it is a circular arc of its flat length and pushes its ends apart; it never
/// pulls. As the paper has them they join interlaced particles (distance 2 along rows, columns and diagonals)
/// and are all of the cloth's bending. Beside bending that is linear in curvature (curvature.hpp) they join
/// neighbours along threads, where they see only what the particles' own places don't: that the cloth between
/// them buckles.
struct BendSprings {
    std::vector<std::uint32_t> i, j;  ///< (springs) particles, i < j
    Coefficients rest;                ///< (springs) L [m], the flat length
    Coefficients stiffness;           ///< (springs) k_b [N·m²]
    Coefficients slope;               ///< (springs) c_b [N/m], before the step's own limit
    std::size_t size() const { return i.size(); }
    /// One more, between particles p and q in either order; c_b such that the push has reached the arc's once
    /// the spring is shorter by the buckling strain.
    void add(std::uint32_t p, std::uint32_t q, double length, double k_b, double buckling_strain) {
        i.push_back(std::min(p, q));
        j.push_back(std::max(p, q));
        rest.push_back(length);
        stiffness.push_back(k_b);
        slope.push_back(12.0 * k_b / (length * length * length * buckling_strain));
    }
};

/// What depends on the step size: the slope that explicit treatment bears, and where it meets the arc's push.
struct BendLimit {
    double h = 0;             ///< s, the step these were made for
    Coefficients slope;       ///< (springs) N/m, min(c_b, limit·m/h²)
    Coefficients crossing;    ///< (springs) m, length below which the arc's push is the weaker
    std::size_t limited = 0;  ///< springs whose slope the step size reduced
};

/// Share of m/h² that the slope of an explicit bend spring may reach. Forward–backward Euler bears an
/// eigenvalue of h²K/m of 4; a particle's eight bend springs together give at most 8 c_b/m, hence one half.
inline constexpr double bend_slope_limit = 0.5;

/// Chebyshev interpolation of F over s in [0, 1], rewritten in powers of 1 − s. The arc's exact relation is
/// implicit (s = sin θ/θ); this is its stated fit.
inline constexpr std::array<double, 11> arc_coefficients{
    -3.0000668506335959, -1.7838760088811887, -1.8684086241163929, 8.6926411869192428,
    -73.700347039509623, 317.53574010698077,  -840.54866385932951, 1371.0890893404605,
    -1353.4347382739654, 741.30518410308287,  -174.15581069378692};

/// Shape of the arc's push: f_b = (4 k_b/L²) F(s) with s = l/L = sin θ/θ, F = θ²/(cos θ − sin θ/θ); F(1) =
/// −3, F(0) = −π². Polynomial in 1 − s, within 4e-5 of the exact value (relative) for every s of [0, 1].
double arc_force(double s);

/// The same for an s that is known to be in [0, 1].
UNRAVEL_LAW double arc_force_within(double s) {
    const double u = 1.0 - s;
    double value = arc_coefficients.back();
    for (std::size_t k = arc_coefficients.size() - 1; k-- > 0;) value = value * u + arc_coefficients[k];
    return value;
}

/// The two pushes of which the weaker acts [N], ≤ 0: c_b (l − L), and `scale` F(l/L) with scale = 4 k_b/L²
/// and l/L in [0, 1].
UNRAVEL_LAW double straight_push(double slope, double length, double rest) {
    return slope * (length - rest);
}
UNRAVEL_LAW double arc_push(double scale, double share) {
    return scale * arc_force_within(share);
}

/// θ², for the arc's energy 2 k_b θ²/L: the integral of 2F from 1 to s, so that force and energy agree to
/// rounding.
double arc_energy(double s);

/// Signed force along û = (x_j − x_i)/l on particle i [N], ≤ 0 (pushes apart): the weaker of the arc's push
/// and c_b (l − L); 0 for l ≥ L.
double bend_force(double length, double rest, double stiffness, double slope);

/// Its slope dT/dl [N/m], ≥ 0; 0 for l ≥ L.
double bend_force_slope(double length, double rest, double stiffness, double slope);

/// Its energy [J], 0 at l ≥ L; `crossing` as BendLimit says.
double bend_energy(double length, double rest, double stiffness, double slope, double crossing);

/// Length at which the two pushes are equal, or 0 if the linear one is the weaker everywhere [m].
double bend_crossing(double rest, double stiffness, double slope);

/// Fills `limit` for step size h, 0: without any, where it is not that already. `mass` is (particles) [kg].
void limit_bend(const BendSprings& springs, std::span<const double> mass, double h, BendLimit& limit);

/// Force on each spring's particle i (on j its opposite) [N]. (springs)
void bend_forces(const BendSprings& springs, const BendLimit& limit, std::span<const Vec3> x,
                 std::span<Vec3> force);

/// Bend springs under a scheme that treats them implicitly, in the linear algebra's terms: the stiffness
/// along û is the push's slope, the transverse part T/l, which is negative where the spring pushes, is left
/// out, so that A stays positive definite. Implicit where compressed, inactive elsewhere.
struct ImplicitBend {
    ExtensionSprings springs;
    ExtensionForces forces;  ///< its forces are bend_forces()
};

/// Fills forces and Jacobians at x. (particles)
void bend_jacobians(const BendSprings& springs, const BendLimit& limit, std::span<const Vec3> x,
                    ImplicitBend& out);

}  // namespace unravel::sim
