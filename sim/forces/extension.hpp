#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/adjacency.hpp"
#include "sim/forces/coefficients.hpp"
#include "sim/forces/extension_law.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Stretch and shear springs: they act only in extension (Choi & Ko 2002; paper Sec. 2.1). Stretch springs
/// come first, cloth by cloth; those of a grid cloth lie direction by direction
/// (sim/forces/grid_springs.hpp).
struct ExtensionSprings {
    std::vector<std::uint32_t> i, j;  ///< (springs) particles, i < j
    Coefficients rest;                ///< (springs) L [m]
    Coefficients stiffness;           ///< (springs) k_s [N/m]
    Coefficients damping;             ///< (springs) k_d [N·s/m]
    std::size_t stretch_count = 0;    ///< springs [0, stretch_count) are stretch, the rest shear
    std::size_t size() const { return i.size(); }
    /// One more, between particles p and q in either order.
    void add(std::uint32_t p, std::uint32_t q, double length, double k_s, double k_d) {
        i.push_back(std::min(p, q));
        j.push_back(std::max(p, q));
        rest.push_back(length);
        stiffness.push_back(k_s);
        damping.push_back(k_d);
    }
};

/// Forces of the extension springs at (x, v), and what their Jacobians are made of:
///   ∂f_i/∂x_j = (k_s − t) ûûᵀ + t I,  t = k_s (1 − L/l),    ∂f_i/∂v_j = k_d ûûᵀ,    ∂f_i/∂x_i = −∂f_i/∂x_j.
/// Both blocks are positive semidefinite for l ≥ L, so that A of Eq. (5) is SPD with nothing clamped.
struct ExtensionForces {
    std::vector<Vec3> force;         ///< (springs) on i, on j its opposite [N]; 0 where slack
    std::vector<Vec3> direction;     ///< (springs) û, unit, from i to j; set where the state is not inactive
    std::vector<double> transverse;  ///< (springs) t ≥ 0 [N/m]; set where the state is not inactive
    std::vector<SpringState> state;  ///< (springs)
    void resize(std::size_t springs);
};

/// One kind of springs as the linear algebra sees it: those of the cloth, or the temporary ones of
/// self-collision.
struct SpringFamily {
    const ExtensionSprings* springs;
    const Adjacency* adjacency;
    const ExtensionForces* forces;
    /// (particles) how far a particle moves without the solve from where these springs were evaluated [m];
    /// empty: as the cloth's.
    std::span<const Vec3> drift{};
    /// (particles) where û and t are to be found anew from [m]; empty: they are in `forces`.
    std::span<const Vec3> at{};
};

/// û and t of an implicit spring.
struct SpringLine {
    Vec3 u;
    double t;
};
inline SpringLine line_of(const SpringFamily& family, std::uint32_t s) {
    if (family.at.empty()) return {family.forces->direction[s], family.forces->transverse[s]};
    const ExtensionSprings& springs = *family.springs;
    const Vec3 d = family.at[springs.j[s]] - family.at[springs.i[s]];
    const double length = d.norm(), rest = springs.rest[s];
    return {d / length, transverse_stiffness(springs.stiffness[s], rest / length)};
}

/// Evaluates all springs at (x, v) for a step of h seconds. `band` ≥ 0: a slack spring with l > (1 − band) L
/// that is handled implicitly gets its Jacobian (t = 0) but no force, so that a pull can travel through it.
/// `taut`, (springs) or empty, marks slack springs that will be taut when the step ends (1) or nearly (2): if
/// implicit the first get their Jacobian (t = 0) and the force k_s (l − L) + k_d û·(v_j − v_i) on their line,
/// a push that the linearised end-of-step force outgrows; the others their Jacobian alone. `ahead`,
/// (particles) or empty: where implicit springs are evaluated instead of at x, but for the line of their
/// damping; one within the band's reach at x but slack there gets its Jacobian (t = 0) and no force.
void extension_forces(const ExtensionSprings& springs, std::span<const double> mass, std::span<const Vec3> x,
                      std::span<const Vec3> v, double h, const Splitting& splitting, double band,
                      ExtensionForces& out, std::span<const std::uint8_t> taut = {},
                      std::span<const Vec3> ahead = {});

/// What a solve took implicit springs for and its end shows otherwise.
struct Misjudged {
    bool missed = false;  ///< one that was left out is longer than (1 + strain) L
    double energy = 0;    ///< J that the others' motion has got from nowhere: what springs that were left out
                          ///< hold, and what slack ones that were to be taut have pushed with
};

/// Corrects the marks `taut`, (springs), of a step of h seconds from x to `end`, (particles): an implicit
/// spring that was inactive in `forces` and is longer than L at the end is marked 1, one that was marked 1,
/// slack, and still is, is marked 2.
Misjudged correct_taut(const ExtensionSprings& springs, std::span<const double> mass, double h,
                       const Splitting& splitting, std::span<const Vec3> x, std::span<const Vec3> end,
                       const ExtensionForces& forces, double strain, std::vector<std::uint8_t>& taut);

/// Marks springs longer than L at `end`, (particles).
void mark_taut(const ExtensionSprings& springs, std::span<const Vec3> end, std::vector<std::uint8_t>& taut);

}  // namespace unravel::sim
