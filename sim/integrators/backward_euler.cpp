#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

// Semi-implicit backward Euler (paper Eq. 5; Baraff & Witkin 1998): one linearisation per step.
const Scheme backward_euler{.name = "implicit",
                            .order = 1,
                            .splitting =
                                [](double) {
                                    return Splitting{always_implicit, always_implicit, always_implicit};
                                },
                            .begin = begin_euler};

void begin_euler(const ClothState& state, double h, Stage& stage) {
    stage.h = h;
    stage.h_force = h;
    stage.x = stage.x_at = state.x;
    stage.x_linear.clear();
    stage.v = stage.v_at = state.v;
}

}  // namespace unravel::sim
