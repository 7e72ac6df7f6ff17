#pragma once

#include "sim/model/model.hpp"

namespace unravel::sim {

/// Whether any of the scene's solids is where its cloth can come within the clip, by a bound that is far too
/// wide rather than too narrow: a free fall from the start with all that throws, blows and carries it, and
/// stretched as far as a run may go. What decides by it must be right either way.
///   model  its cloths, pins and solids;  placement  (particles) the start
bool can_come_near(const Scene& scene, const ClothModel& model, const Placement& placement);

}  // namespace unravel::sim
