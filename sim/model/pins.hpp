#pragma once

#include <vector>

#include "sim/model/model.hpp"

namespace unravel::sim {

/// Appends what the cloth's pins hold: a group for each that holds any particle. `begin`: where the clip
/// begins [s], from which rows are drawn together.
///   placement   of all particles so far, those of the cloth included
void add_pins(const Cloth& cloth, const ClothPatch& patch, double begin, const Placement& placement,
              std::vector<PinnedGroup>& groups);

}  // namespace unravel::sim
