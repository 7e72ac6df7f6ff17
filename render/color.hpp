#pragma once

#include <Eigen/Core>
#include <cmath>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// One sRGB-encoded channel in [0, 1] to linear light. IEC 61966-2-1.
inline float srgb_to_linear(float s) {
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

/// The inverse of srgb_to_linear.
inline float linear_to_srgb(float l) {
    return l <= 0.0031308f ? l * 12.92f : 1.055f * std::pow(l, 1 / 2.4f) - 0.055f;
}

inline Vec3f linear(Rgb c) {
    return {srgb_to_linear(c.r / 255.f), srgb_to_linear(c.g / 255.f), srgb_to_linear(c.b / 255.f)};
}

}  // namespace unravel::render
