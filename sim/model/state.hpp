#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A particle touching a solid, carried from step to step.
struct Contact {
    std::uint32_t particle = 0;
    std::uint32_t solid = 0;
    bool held = false;         ///< static friction: the particle moves with the solid
    bool begins = false;       ///< was held by more than friction can, and now slides towards `slip`
    std::uint8_t sliding = 0;  ///< steps for which it has yet to be seen stopped before it is held again
    double force = 0;    ///< N, normal force of the last step; negative: it pulled, and is to be released
    Vec3 slip{0, 0, 0};  ///< m/s along the solid, foreseen for the next step; of what begins a direction
};

/// What a checkpoint holds: everything that a next step reads.
struct ClothState {
    std::uint64_t step = 0;         ///< steps taken
    double t = 0;                   ///< s
    std::vector<Vec3> x, v;         ///< (particles) [m], [m/s]
    std::vector<Vec3> dv;           ///< (particles) Δv of the last step, the next solve's first guess [m/s]
    std::vector<Contact> contacts;  ///< sorted by particle, then solid; empty without solids
    /// Adaptive step: how often the scene's step is halved at present, how many of its largest parts are
    /// done, how many parts of the next one, and the largest strain then. All zero where the step is fixed.
    std::uint8_t halvings = 0;
    std::uint64_t whole_steps = 0;
    std::uint32_t part = 0;
    double strain = 0;
    double h_previous = 0;  ///< s, size of the last step; 0 at the start (multistep schemes then start up)
    std::vector<Vec3> x_previous, v_previous;  ///< (particles) one step ago; empty for one-step schemes
};

}  // namespace unravel::sim
