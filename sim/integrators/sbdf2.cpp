#include "sim/integrators/scheme.hpp"

namespace unravel {

// The second-order pair of adaptive IMEX: backward differentiation for the stiff springs, extrapolation for
// the soft ones (SBDF2 of Ascher, Ruuth & Wetton 1995; variable steps after Wang & Ruuth 2008), split by
// Eq. (7). The extrapolation is that of the state, not of the force: a soft spring that goes slack then stops
// pulling instead of pushing back.
const Scheme sbdf2{"adaptive-imex2", 2,     [](double threshold) { return Splitting{threshold, threshold}; },
                   begin_bdf2,       false, true};

}  // namespace unravel
