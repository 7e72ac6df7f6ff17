#pragma once

#include <algorithm>
#include <cmath>

#include "sim/forces/law.hpp"

namespace unravel::sim {

/// What the air does to a cell (sim/forces/air.hpp): F = drag (r·n) n + lift (r − (r·n) n), both [N·s/m].
struct AirPush {
    double drag, lift;
};
/// The law of air resistance and lift.
///   air    its density [kg/m³] and the cell's coefficients, as members density, drag and lift
///   area   of the cell [m²]
///   along  r·n [m/s];  speed  |r| [m/s]
///   bound  the most that either may be [N·s/m]: the cell's lightest corner over the step, so that the air
///   can bring a
///          cell to its own speed within a step, never beyond
template <typename Air>
UNRAVEL_LAW AirPush air_push(const Air& air, double area, double along, double speed, double bound) {
    const double half = 0.5 * air.density * area;
    return {std::min(half * air.drag * std::abs(along), bound), std::min(half * air.lift * speed, bound)};
}

}  // namespace unravel::sim
