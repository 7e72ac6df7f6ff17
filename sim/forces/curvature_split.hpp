#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sim/forces/curvature.hpp"
#include "sim/forces/extension.hpp"

namespace unravel::sim {

/// A bound on the eigenvalues λ of M⁻¹K of bending's stencils, particle by particle (Gershgorin):
///   λ ≤ max of Σ c |w_k| Σ|w|/m_k over the stencils of each.
/// On grids the largest is the largest eigenvalue itself. Those of stencils for which takes(stencil) [1/s²],
/// (particles).
template <typename F>
std::vector<double> curvature_bounds(const CurvatureStencils& stencils, std::span<const double> mass,
                                     const F& takes) {
    std::vector<double> bounds(mass.size(), 0.0);
    for (std::size_t s = 0; s < stencils.size(); ++s) {
        if (!takes(s)) continue;
        double weight = 0;
        for (const Coefficients& w : stencils.w) weight += std::abs(w[s]);
        for (std::uint32_t k = 0; k < stencils.count(s); ++k) {
            const std::uint32_t p = stencils.p[s][k];
            bounds[p] += stencils.stiffness[s] * std::abs(stencils.w[k][s]) * weight / mass[p];
        }
    }
    return bounds;
}

/// κ of a stencil: an eighth of the largest h²λ that the bounds of all stencils allow at its particles, since
/// on a grid whose springs share one κ of Eq. (7) h²λ ≤ 8κ. κ ≤ ½ is stable here as there.
inline double curvature_kappa(const CurvatureStencils& stencils, std::span<const double> bounds, double h,
                              std::size_t s) {
    double largest = 0;
    for (const std::uint32_t p : stencils.p[s]) largest = std::max(largest, bounds[p]);
    return h * h * largest / 8;
}

/// κ up to which explicit treatment is stable (paper Sec. 3.5).
inline constexpr double stable_kappa = 0.5;

/// Which stencils a step of h seconds treats implicitly, (stencils): those of κ above the splitting's
/// threshold, or above twice the threshold where no spring of their particles is explicit, too; and those
/// that would add up with the springs to more than is stable, unless the threshold itself asks for that.
std::vector<std::uint8_t> implicit_curvature(const CurvatureStencils& stencils,
                                             const ExtensionSprings& springs, std::span<const double> mass,
                                             double h, const Splitting& splitting);

}  // namespace unravel::sim
