#pragma once

#include <cstdint>
#include <stdexcept>

#include "sim/model/model.hpp"
#include "sim/step/plan.hpp"

namespace unravel::sim {

/// How near what a scheme handles explicitly brings a step to its limit of stability.
///
/// Forward–backward Euler (paper Eq. 3) with explicit damping bears modes with h²λ + 2hμ < 4, λ and μ the
/// eigenvalues of M⁻¹K and M⁻¹D; the second-order pair 3.2 (sim/integrators/bdf2.cpp). For springs alone,
/// with particle i's own block K_i = Σ_j k ûûᵀ,
///   λ ≤ 2 max_i λmax(K_i)/m_i,
/// and on a grid whose springs share one κ (7) the bound is 8κ: two stretch springs along a row and half of
/// four diagonals. That is the paper's κ ≤ ½. Bending that is linear in curvature adds its own bound
/// (sim/forces/curvature_split.hpp). Arcs are limited to what a step bears.
struct ExplicitLimit {
    double share =
        0;  ///< max (h²λ + 2hμ)/4, or its like, as bounded above, of the cloth laid flat; < 1: stable
    std::uint32_t particle = 0;  ///< where
    double kappa = 0;            ///< largest κ of what is explicit there
    double step =
        0;  ///< s, largest stable step; +∞ where nothing is explicit, and for a split that follows h
};

/// Substeps that a step may be divided into. More would be tens of times dearer than any other way, and
/// nobody would hear of it.
inline constexpr double most_substeps = 1e5;

/// Substeps of `explicit` that bring a step of h seconds below its limit of stability by a margin, at least
/// 1, where its largest stable step is `stable` seconds.
double stable_substeps(double h, double stable);

ExplicitLimit explicit_limit(const ClothModel& model, const StepOptions& options, double h);

/// A step that the explicit springs don't bear. what() names the limit and what to change. Exit code 3.
class UnstableStep : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws UnstableStep where the share is 1 or more, or where it would take too many substeps.
void require_explicit_stability(const ClothModel& model, const StepOptions& options, double h);

}  // namespace unravel::sim
