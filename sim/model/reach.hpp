#pragma once

#include "sim/model/model.hpp"

namespace unravel::sim {

/// Where a scene's cloth can come within the clip, by a bound that is far too wide rather than too narrow: a
/// free fall from the start with all that throws, blows and carries it, and stretched as far as a run may go.
/// What decides by it must be right either way.
struct Reach {
    Vec3 centre{0, 0, 0};  ///< m, of where it starts
    double way = 0;        ///< m, farther from there neither it nor a solid's own motion takes it
    /// Whether it can come to the solid, wherever that goes.
    bool meets(const Solid& solid) const;
};

///   model  its cloths, pins and solids;  placement  (particles) the start
Reach reach_of(const Scene& scene, const ClothModel& model, const Placement& placement);

}  // namespace unravel::sim
