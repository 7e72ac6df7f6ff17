#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

const Scheme& scheme_of(Integrator choice) {
    switch (choice) {
        case Integrator::explicit_:
            return forward_backward_euler;
        case Integrator::implicit:
            return backward_euler;
        case Integrator::newton:
            return newton_euler;
        case Integrator::imex:
            return fixed_imex;
        case Integrator::bdf2:
            return bdf2;
        case Integrator::adaptive_imex2:
            return sbdf2;
        case Integrator::automatic:  // where it does not take explicit substeps
        case Integrator::adaptive_imex:
            break;
    }
    return adaptive_imex;
}

}  // namespace unravel::sim
