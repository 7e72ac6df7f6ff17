#pragma once

#include <cstdint>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Gradient noise (Perlin, "Improving noise", 2002): from −1 to 1, 0 at whole numbers, with continuous first
/// and second derivatives, and about one hill or hollow per unit of length. A pure function of seed and
/// place.
double smooth_noise(std::uint64_t seed, const Vec3& at);

}  // namespace unravel::sim
