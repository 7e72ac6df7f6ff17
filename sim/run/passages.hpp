#pragma once

#include "sim/model/contact_model.hpp"
#include "sim/model/report.hpp"
#include "sim/surface/crossings.hpp"

namespace unravel::sim {

/// What passes through what, counted without regard to how contact is kept, so that it can be judged by it.
struct Passages {
    std::vector<Crossing> cloth;         ///< edges of cloth through faces of cloth
    std::uint64_t solids = 0;            ///< edges of cloth that pass through a solid's surface
    double deepest = 0;                  ///< m, how far cloth is inside a solid, skin not counted; 0: nowhere
    std::uint32_t deepest_particle = 0;  ///< a corner of the face that is deepest
    std::uint32_t deepest_solid = 0;
    std::uint64_t count() const { return cloth.size() + solids; }
};

/// Counts at positions x of time t. Crossings of cloth with cloth only where the scene calls for
/// self-collision: cloth that may pass through itself is not counted doing so.
Passages find_passages(const ClothModel& model, double t, std::span<const Vec3> x);

}  // namespace unravel::sim
