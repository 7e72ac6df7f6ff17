#pragma once

#include "sim/constraints/constraints.hpp"
#include "sim/self_collision/surface_contact.hpp"

namespace unravel::sim {

/// What keep_apart() did.
struct Apart {
    bool kept = true;           ///< false: what is prescribed drives cloth through cloth, at `particles`
    std::uint32_t impacts = 0;  ///< pairs that would have met
    std::uint32_t zones = 0;    ///< groups of particles that had to move as one
    std::array<std::uint32_t, 4> particles{};  ///< a pair that could not be kept apart
};

struct KeepApartWorkspace {
    std::vector<Vec3> step;                         ///< (particles) how far each goes [m]
    std::vector<double> gap;                        ///< (pairs) m, what is kept between them
    std::vector<std::uint8_t> moved;                ///< (particles) 1: since pairs were last looked at
    std::vector<std::vector<std::uint32_t>> found;  ///< (chunks of pairs) those that meet
    std::vector<std::uint32_t> impacts;
    std::vector<std::uint8_t> fixed;  ///< (particles) 1: pinned
    std::vector<std::uint32_t> zone;  ///< (particles) parent in the zones' forest
};

/// Lets no surface pass through another while particles go straight from x to `end`: pairs that would meet
/// are stopped along the line between them, as an inelastic impact does, which takes energy and never gives
/// any (Bridson, Fedkiw & Anderson 2002, Sec. 7); where impacts go on among themselves, the particles of a
/// group move as one (Provot 1997; Harmon et al. 2008), which keeps them as they were to each other. From a
/// start without crossings the end has none either, nor any instant between.
///   x     (particles) where they are; without crossings [m]
///   fixed (particles) 1: pinned, and never changed; what touches a solid leaves it where nothing else helps
///   end   (particles) where they go, changed [m]
Apart keep_apart(const ClothModel& model, std::span<const Vec3> x, const Constraints& constraints,
                 std::span<const std::uint8_t> fixed, std::span<Vec3> end, SurfaceContactWorkspace& ws,
                 KeepApartWorkspace& scratch);

}  // namespace unravel::sim
