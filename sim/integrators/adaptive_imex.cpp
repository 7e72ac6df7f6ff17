#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

// IMEX Euler (paper Eq. 6) split by the stability criterion of each spring in each step (Sec. 3.5, Eq. 7).
const Scheme adaptive_imex{"adaptive-imex", 1,
                           [](double threshold) {
                               return Splitting{threshold, threshold, threshold};
                           },
                           begin_euler};

}  // namespace unravel::sim
