#pragma once

// The law of stretch and shear springs, and of what a step makes of them (sim/forces/law.hpp).

#include <algorithm>
#include <cstdint>

#include "sim/forces/law.hpp"

namespace unravel::sim {

/// What a spring does in a step. Inactive: slack, neither force nor Jacobian. Explicit: force only. Implicit:
/// force and Jacobian, hence an edge of the component graph.
enum class SpringState : std::uint8_t { inactive, explicit_, implicit };

/// Whether a spring is longer than L: a slack one has neither force nor energy. Both lengths, or both their
/// squares.
UNRAVEL_LAW bool is_taut(double length, double rest) {
    return length > rest;
}

/// By what a spring pulls its ends together [N]: k_s (l − L) on the line where it is evaluated, and k_d times
/// the rate at which it lengthens.
struct SpringPull {
    double elastic, damped;
    UNRAVEL_LAW double sum() const { return elastic + damped; }
};
UNRAVEL_LAW SpringPull spring_pull(double stiffness, double extension, double damping, double rate) {
    return {stiffness * extension, damping * rate};
}

/// t = k_s (1 − L/l) [N/m], the Jacobian's part across the spring; 0 where slack.
UNRAVEL_LAW double transverse_stiffness(double stiffness, double rest_over_length) {
    const double slack = 1.0 - rest_over_length;
    return stiffness * (slack > 0 ? slack : 0.0);
}

/// Energy of one spring [J].
UNRAVEL_LAW double extension_energy(double length, double rest, double stiffness) {
    const double e = length - rest;
    return e > 0 ? 0.5 * stiffness * e * e : 0.0;
}

/// (l − L)/L
UNRAVEL_LAW double spring_strain(double length, double rest) {
    return length / rest - 1.0;
}

/// κ of Eq. (7), dimensionless. inverse_mass is 1/m of the lighter end [1/kg].
UNRAVEL_LAW double kappa(double h, double inverse_mass, double stiffness, double damping) {
    return h * inverse_mass * (stiffness * h + 2.0 * damping);
}
UNRAVEL_LAW double kappa_between(double h, double mass_i, double mass_j, double stiffness, double damping) {
    return kappa(h, 1.0 / std::min(mass_i, mass_j), stiffness, damping);
}

/// Which springs are implicit (paper Sec. 3.5): κ = (h/m)(k_s h + 2 k_d), Eq. (7), m the smaller mass. A
/// spring is explicit where κ ≤ threshold; +∞ makes all explicit, a negative one all implicit. Bending has a
/// κ of its own (sim/forces/curvature.hpp).
struct Splitting {
    double stretch_threshold = 0.2;
    double shear_threshold = 0.2;
    double bend_threshold = 0.2;
    double threshold(bool is_stretch) const { return is_stretch ? stretch_threshold : shear_threshold; }
    friend bool operator==(const Splitting&, const Splitting&) = default;
};
UNRAVEL_LAW bool is_explicit(double of_spring, double threshold) {
    return of_spring <= threshold;
}

/// The splitting's decision for one spring.
struct SpringSplit {
    bool bears;    ///< κ is within the threshold: explicit treatment bears it
    bool taut;     ///< longer than L
    bool reached;  ///< longer than the reach, (1 − band) L, up to which a slack spring is not made implicit
    bool joins;    ///< will be taut at the step's end
    bool apart;    ///< its ends are, so that it has a line to act on
    /// Whether it pulls, or, where it is to be taut only at the step's end, pushes.
    UNRAVEL_LAW bool pulls() const {
        const bool implicit = !bears;
        return taut | (joins & implicit & apart);
    }
    /// Its SpringState, as wide as what loops over springs compute with.
    UNRAVEL_LAW std::int64_t code() const {
        const bool implicit = !bears, reaches = reached | (joins & apart);
        return implicit & reaches ? 2 : (taut ? 1 : 0);
    }
    UNRAVEL_LAW SpringState state() const { return static_cast<SpringState>(code()); }
};

}  // namespace unravel::sim
