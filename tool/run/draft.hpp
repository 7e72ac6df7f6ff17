#pragma once

#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Particles of a draft, and steps that it takes a second, unless the scene has fewer.
inline constexpr int draft_particles = 900, draft_steps = 240;

/// The scene for a quick look: grids so coarse that all cloths together have about `particles`, and steps no
/// shorter than a draft's. Meshes stay as they are. Pins by indices hold the same part of the coarser grid,
/// and those of which a coarser grid would have no particle hold the nearest.
Scene draft_of(Scene scene, int particles = draft_particles);

}  // namespace unravel::tool
