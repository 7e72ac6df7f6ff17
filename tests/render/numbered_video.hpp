#pragma once

// Videos whose frames tell their number.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "render/video.hpp"

namespace unravel::testing {

using namespace render;
namespace fs = std::filesystem;

inline constexpr int width = 128, height = 96;

inline VideoSettings small_settings(int fps = 30) {
    VideoSettings settings;
    settings.width = width;
    settings.height = height;
    settings.fps_num = fps;
    return settings;
}

inline void fill(Image& image, int x0, int y0, int w, int h, std::array<int, 3> colour) {
    for (int y = y0; y < y0 + h; ++y)
        for (int x = x0; x < x0 + w; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(colour[c]);
}

inline Image plain_image(std::array<int, 3> colour) {
    Image image{width, height, std::vector<std::uint8_t>(width * height * 4, 255)};
    fill(image, 0, 0, width, height, colour);
    return image;
}

/// The frame's number in binary: eight 16 × 16 patches, white for 1, over a bar that moves.
inline Image numbered_image(int number) {
    Image image = plain_image({90, 60, 40});
    for (int bit = 0; bit < 8; ++bit) {
        const int level = number >> bit & 1 ? 255 : 0;
        fill(image, 16 * bit, 0, 16, 16, {level, level, level});
    }
    fill(image, number % (width - 8), 40, 8, 40, {200, 30, 60});
    return image;
}

inline int read_number(const Image& image) {
    int number = 0;
    for (int bit = 0; bit < 8; ++bit) number |= (image.at(16 * bit + 8, 8)[1] > 127 ? 1 : 0) << bit;
    return number;
}

inline std::string write_numbered(const fs::path& file, const VideoSettings& settings, int frames) {
    VideoWriter writer(file, settings);
    for (int k = 0; k < frames; ++k) writer.add(numbered_image(k));
    writer.finish();
    CHECK(writer.frames() == frames);
    return writer.description();
}

inline int largest_difference(const Image& a, const Image& b) {
    int largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        if (i % 4 != 3) largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    return largest;
}

}  // namespace unravel::testing
