#pragma once

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Where one of the many pictures of a final one stands.
struct Sample {
    Vec2f pixel{0, 0};   ///< from its middle, within half a pixel
    Vec2f lens{0, 0};    ///< in the unit disk
    Vec2f lamp{0, 0};    ///< likewise
    Vec3f sky{0, 1, 0};  ///< unit, spread evenly over the upper half
};

/// The k-th of any number of them: each part from a sequence of its own whose first so many values, and any
/// that follow each other, spread evenly. [Halton 1964; for the sky and the pixel Roberts 2018, The
/// Unreasonable Effectiveness of Quasirandom Sequences]
Sample sample_at(int k);

}  // namespace unravel::render
