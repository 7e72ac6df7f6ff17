#pragma once

#include "sim/run/simulate.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// What a run of a scene is expected to take of a machine like this one.
struct Forecast {
    long steps = 0;              ///< with those before frame 0
    double seconds = 0;          ///< of one core, in simulating
    bool longer = false;         ///< not a step came to its end while it was tried: `seconds` are too few
    double picture_seconds = 0;  ///< of one core, in drawing, writing and encoding both views
    double bytes = 0, bytes_with_pictures = 0;  ///< of memory, at its peak
};

/// Tried, not guessed: a cloth of this scene, or of one that is too large a piece of it with cells of the
/// same size, goes through its first steps, and a coarse one through the whole clip, which tells how much
/// more later steps take than the first. Takes a second or two of one core. Throws what the simulation
/// throws but for steps that can't go on.
///   simulation  of the scene, at its start
Forecast forecast(const Scene& scene, const Simulation& simulation);

}  // namespace unravel::tool
