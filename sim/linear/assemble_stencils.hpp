#pragma once

#include <span>

#include "sim/linear/system.hpp"

namespace unravel::sim {

/// Adds to A and b, as springs have left them, what implicit stencils put there (sim/forces/stencil.hpp): its
/// blocks, its diagonal and b. For rows that are made by assemble(); `constraints` know z of those whose
/// effect goes to b. Without an implicit stencil `blocks` and `block_start` end up empty.
void assemble_stencils(std::span<const Stencils> lists, const Load& load, const Components& components,
                       const Constraints& constraints, double h, System& out);

}  // namespace unravel::sim
