#pragma once

#include "sim/forces/air.hpp"
#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Air resistance and lift (sim/forces/air.hpp).
extern const ForceTerm air_term;

/// Empty without wind.
struct AirMemory {
    AirCells cells;
    std::vector<Vec3> force;  ///< (cells) N; empty where it is evaluated along rows
    StiffAir stiff;           ///< of this step; empty where all is explicit
};

}  // namespace unravel::sim
