#pragma once

#include "render/draw_scene.hpp"

namespace unravel::testing {

using namespace render;

/// Nothing but a background, in both views.
inline DrawScene empty_scene(Rgb background) {
    DrawScene scene;
    scene.background = scene.components_background = background;
    scene.show_ground = false;
    return scene;
}

inline Rgb pixel(const Image& image, int x, int y) {
    const std::uint8_t* p = image.at(x, y);
    return {p[0], p[1], p[2]};
}

}  // namespace unravel::testing
