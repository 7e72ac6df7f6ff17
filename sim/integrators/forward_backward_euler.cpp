#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

// Forward–backward Euler (paper Eq. 3): v' = v + h M⁻¹ f(x, v), x' = x + h v'. With no implicit spring the
// stage of Eq. (5) is just that, and its matrix is M.
const Scheme forward_backward_euler{"explicit", 1,
                                    [](double) {
                                        return Splitting{always_explicit, always_explicit, always_explicit};
                                    },
                                    begin_euler};

}  // namespace unravel::sim
