#pragma once

#include "sim/terms/term.hpp"

namespace unravel::sim {

/// The weight m g of every particle.
extern const ForceTerm gravity_term;

/// Its energy, 0 at the origin [J]. (particles)
double height_energy(const ClothModel& model, std::span<const Vec3> x);

}  // namespace unravel::sim
