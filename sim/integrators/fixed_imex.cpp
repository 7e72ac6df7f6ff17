#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

// IMEX Euler (paper Eq. 6) split by the kind of spring: stretch implicit, shear explicit (Eberhardt et al.
// 2000, Hauth et al. 2002); bending explicit where it bears that, which its κ says.
const Scheme fixed_imex{"imex", 1,
                        [](double threshold) {
                            return Splitting{always_implicit, always_explicit, threshold};
                        },
                        begin_euler};

}  // namespace unravel::sim
