#pragma once

#include <functional>
#include <span>
#include <vector>

#include "sim/scene/scene.hpp"
#include "tool/plot/plot.hpp"

namespace unravel {

/// CG iterations of one preconditioner on the systems of one mesh (paper Fig. 9).
struct PreconditionerPoint {
    Preconditioner preconditioner = Preconditioner::none;
    std::size_t particles = 0;
    double iterations = 0;   ///< per solve: mean over the systems, components weighted by their rows
    double constrained = 0;  ///< share of particles with no free direction
    double partly = 0;       ///< share with one or two
};

/// Refines the scene's first cloth to each of `sides` particles squared, simulates `from` seconds of it, and
/// then solves each of the next `systems` steps' very same systems with every one of `kinds`, all by the one
/// stopping rule and from the same guess.
///   keep_on  asked before every step; false ends the study with the meshes finished so far
std::vector<PreconditionerPoint> study_preconditioners(const Scene& scene, std::span<const int> sides,
                                                       double from, int systems,
                                                       std::span<const Preconditioner> kinds,
                                                       const std::function<bool()>& keep_on);

/// Iterations over particles, log–log.
Plot preconditioner_plot(std::span<const PreconditionerPoint> points);

}  // namespace unravel
