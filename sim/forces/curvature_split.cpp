#include "sim/forces/curvature_split.hpp"

namespace unravel::sim {

std::vector<std::uint8_t> implicit_curvature(const CurvatureStencils& stencils,
                                             const ExtensionSprings& springs, std::span<const double> mass,
                                             double h, const Splitting& splitting) {
    std::vector<std::uint8_t> shared(mass.size(), 0);  // (particles) 1: with an explicit spring
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const std::uint32_t i = springs.i[s], j = springs.j[s];
        const double of_spring = kappa_between(h, mass[i], mass[j], springs.stiffness[s], springs.damping[s]);
        if (of_spring > 0 && is_explicit(of_spring, splitting.threshold(s < springs.stretch_count)))
            shared[i] = shared[j] = 1;
    }
    const std::vector<double> bounds = curvature_bounds(stencils, mass, [](std::size_t) { return true; });
    std::vector<std::uint8_t> implicit(stencils.size());
    for (std::size_t s = 0; s < stencils.size(); ++s) {
        const bool alone =
            std::ranges::all_of(stencils.p[s], [&](std::uint32_t p) { return shared[p] == 0; });
        implicit[s] =
            curvature_kappa(stencils, bounds, h, s) > (alone ? 2.0 : 1.0) * splitting.bend_threshold;
    }
    return implicit;
}

}  // namespace unravel::sim
