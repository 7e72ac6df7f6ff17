#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

// The second-order pair of adaptive IMEX: backward differentiation for the stiff springs, extrapolation for
// the soft ones (as SBDF2 of Ascher, Ruuth & Wetton 1995, but for the extrapolation, see bdf2.cpp; variable
// steps after Wang & Ruuth 2008), split by Eq. (7). The extrapolation is that of the state, not of the force:
// a soft spring that goes slack then stops pulling instead of pushing back. Bending has the smaller share of
// what explicit treatment bears here.
const Scheme sbdf2{.name = "adaptive-imex2",
                   .order = 2,
                   .splitting =
                       [](double threshold) {
                           return Splitting{threshold, threshold, 0.6 * threshold};
                       },
                   .begin = begin_bdf2,
                   .multistep = true,
                   .explicit_bound = 3.2};

}  // namespace unravel::sim
