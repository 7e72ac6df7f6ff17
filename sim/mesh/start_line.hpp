#pragma once

#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// The line in the plane of (axis, normal) that a sheet follows in one of its directions at the start:
/// straight pieces and arcs of circles that pass into each other without a corner. As it is as long as the
/// sheet, the sheet is bent by it and not stretched.
struct StartLine {
    /// Along `length` [m] the direction turns evenly by `turn` [rad], to the left where it is positive.
    struct Piece {
        double length = 0, turn = 0;
    };
    std::vector<Piece> pieces;
    double heading = 0;  ///< rad, of the direction at its beginning, from the axis towards the normal
    Vec2 origin{0, 0};   ///< m, from its beginning: what stands at the cloth's centre
};

struct LinePoint {
    Vec2 at;      ///< m, from the origin
    Vec2 normal;  ///< unit, to the left of the line: the cloth's front
};

/// The point `s` [m] from the beginning; before it and after its end the line goes on straight.
LinePoint point_along(const StartLine& line, double s);

/// The line of a start shape for a sheet of this length [m] along it. Its origin is the middle of pleats and
/// of folds, the axis of the outermost turn of a roll, and the axis of the bar.
StartLine make_start_line(const Start& start, double length);

/// What of a start shape does not fit a sheet of this length, and what would; empty: nothing.
struct UnfitStart {
    std::string what, hint;
};
UnfitStart unfit_start(const Start& start, double length);

}  // namespace unravel::sim
