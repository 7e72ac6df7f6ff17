#include "sim/model/moduli.hpp"

#include <fmt/format.h>

namespace unravel::sim {

std::string weak_shear_note(const Cloth& cloth, double least_share, const std::string& cells) {
    return fmt::format(
        "cloth {}: its shear modulus is down to {:.2g} of what the material says, because the diagonals of "
        "cells of {} would otherwise resist stretch by more than half of the material's; squarer cells, less "
        "shear or more stretch would keep it",
        cloth.name, least_share, cells);
}

}  // namespace unravel::sim
