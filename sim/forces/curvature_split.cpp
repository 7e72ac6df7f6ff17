#include "sim/forces/curvature_split.hpp"

namespace unravel::sim {

std::vector<std::uint8_t> implicit_curvature(const CurvatureStencils& stencils,
                                             const ExtensionSprings& springs, std::span<const double> mass,
                                             double h, const Splitting& splitting) {
    std::vector<double> taken(mass.size(), 0.0);  // (particles) largest κ of explicit springs
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const std::uint32_t i = springs.i[s], j = springs.j[s];
        const double of_spring = kappa_between(h, mass[i], mass[j], springs.stiffness[s], springs.damping[s]);
        if (!is_explicit(of_spring, splitting.threshold(s < springs.stretch_count))) continue;
        for (const std::uint32_t p : {i, j}) taken[p] = std::max(taken[p], of_spring);
    }
    const std::vector<double> bounds = curvature_bounds(stencils, mass, [](std::size_t) { return true; });
    const double threshold = splitting.bend_threshold;
    std::vector<std::uint8_t> implicit(stencils.size());
    for (std::size_t s = 0; s < stencils.size(); ++s) {
        double most = 0;
        for (const std::uint32_t p : stencils.p[s]) most = std::max(most, taken[p]);
        double limit = (most > 0 ? 1.0 : 2.0) * threshold;
        if (threshold <= stable_kappa) limit = std::min(limit, stable_kappa - most);
        implicit[s] = curvature_kappa(stencils, bounds, h, s) > limit;
    }
    return implicit;
}

}  // namespace unravel::sim
