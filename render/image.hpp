#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace unravel::render {

/// 8-bit sRGB RGBA picture, top row first, rows tightly packed.
struct Image {
    int width = 0, height = 0;         ///< pixels
    std::vector<std::uint8_t> pixels;  ///< (height × width × 4)

    const std::uint8_t* at(int x, int y) const {
        return pixels.data() + 4 * (static_cast<std::size_t>(y) * width + x);
    }
    std::uint8_t* at(int x, int y) { return pixels.data() + 4 * (static_cast<std::size_t>(y) * width + x); }
};

}  // namespace unravel::render
