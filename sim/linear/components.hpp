#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/constraints/constraints.hpp"
#include "sim/forces/stencil.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// The independent parts of one step's system (paper Sec. 5): connected components of the graph whose
/// vertices are particles and whose edges are active springs handled implicitly, and implicit stencils, each
/// of which joins all of its particles. Fully constrained particles belong to none and stop the search. Ids
/// follow each component's smallest particle, so they depend on nothing but the graph.
struct Components {
    std::vector<std::int32_t> label;  ///< (particles) component, −1: fully constrained
    std::vector<std::uint32_t>
        order;  ///< (particles) component by component, each sorted; then the fully constrained
    std::vector<std::uint32_t> start;  ///< (components + 1) where each begins in `order`
    std::size_t count() const { return start.empty() ? 0 : start.size() - 1; }
    std::uint32_t size(std::size_t c) const { return start[c + 1] - start[c]; }
    std::uint32_t largest() const;
};

/// Finds them by union–find over springs and stencils, O(n). `parent` is scratch that keeps its memory
/// between calls.
void find_components(std::size_t particles, const Couplings& couplings, const Constraints& constraints,
                     std::vector<std::uint32_t>& parent, Components& out);

/// Whether anything is implicit; without, every free particle is alone.
bool any_implicit(const Couplings& couplings);

/// The undecomposed system: every particle, constrained or not, in one component.
void whole_cloth(std::size_t particles, Components& out);

/// What find_components() gives where nothing is implicit: every free particle by itself.
void lone_particles(std::size_t particles, const Constraints& constraints, Components& out);

}  // namespace unravel::sim
