#pragma once

#include "sim/forces/air.hpp"
#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Air resistance and lift (sim/forces/air.hpp).
extern const ForceTerm air_term;

/// Empty without wind, and where forces are evaluated along rows.
struct AirMemory {
    AirCells cells;
    std::vector<Vec3> force;  ///< (cells) N
};

}  // namespace unravel::sim
