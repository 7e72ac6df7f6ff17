#pragma once

#include "sim/model/contact_model.hpp"
#include "sim/model/report.hpp"
#include "sim/surface/crossings.hpp"

namespace unravel::sim {

/// What passes through what, counted without regard to how contact is kept, so that it can be judged by it.
struct Passages {
    std::vector<Crossing> cloth;  ///< edges of cloth through faces of cloth
    std::optional<std::uint64_t>
        solids;          ///< edges of cloth through solids; absent where there are none to cut
    double deepest = 0;  ///< m, how far cloth is inside a solid, skin not counted; 0: nowhere
    std::uint32_t deepest_particle = 0;  ///< a corner of the face that is deepest
    std::uint32_t deepest_solid = 0;
    bool may_cross = false;  ///< several cloths, or self-collision: crossings were counted
    std::optional<std::uint64_t> cloth_count() const {
        return may_cross ? std::optional<std::uint64_t>(cloth.size()) : std::nullopt;
    }
};

/// Counts at positions x of time t. Crossings of cloth with cloth where the scene has several cloths or calls
/// for self-collision; a single cloth without it passes through itself, and nobody counts. Through solids of
/// a closed form but planes, which no edge between particles outside can cut: edges that enter and leave
/// where the surface looks another way, or deeper than the solid's skin. What sags a little into a ball
/// between particles that lie on it is no crossing, but has its depth. Does nothing for a model without
/// surfaces (ClothModel::contact).
Passages find_passages(const ClothModel& model, double t, std::span<const Vec3> x);

}  // namespace unravel::sim
