#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

// Backward Euler as it stands (paper Eq. 4): the nonlinear system is solved by Newton's method, of which
// Eq. (5) is the first iteration (Hauth et al. 2002).
const Scheme newton_euler{.name = "newton",
                          .order = 1,
                          .splitting =
                              [](double) {
                                  return Splitting{always_implicit, always_implicit, always_implicit};
                              },
                          .begin = begin_euler,
                          .iterates = true};

}  // namespace unravel::sim
