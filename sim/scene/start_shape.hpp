#pragma once

// How a cloth lies at the start (see scene.hpp for units and axes).

#include <cstdint>
#include <string>

#include "sim/scene/enums.hpp"

namespace unravel::sim {

/// How a sheet lies at the start, before it is turned: along one of its directions it follows a line of
/// straight pieces and arcs of circles, so that it is as long as flat.
struct Start {
    StartShape shape = StartShape::pleated;
    std::string from = "u0";  ///< edge at which the line begins
    int pleats = 8;           ///< pleated: waves
    double width = 0;         ///< m, pleated: what is left of the length; 0: half
    int folds = 1;            ///< folded: one less than layers
    double gap = 0.01;        ///< m, folded, rolled: between layers
    double radius = 0.05;     ///< m, rolled: of its hollow; over a bar: of the bend
    double flat = 0;          ///< m, rolled: left flat at its end
    double share = 0.5;       ///< over a bar: where along the line the bar is
};

/// Smooth random displacement along the normal at the start.
struct Wrinkles {
    double height = 0.01;    ///< m, the largest
    double size = 0.15;      ///< m, from one wrinkle to the next
    std::uint32_t seed = 1;  ///< another seed, other wrinkles
};

}  // namespace unravel::sim
