#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/file_errors.hpp"
#include "render/image.hpp"

namespace unravel::render {

struct PngOptions {
    int level = 1;       ///< zlib's, 1 (fast) to 9; beyond 3 rendered frames gain almost nothing
    bool alpha = false;  ///< RGBA; otherwise the alpha is left out and the file is RGB
};

/// An 8-bit sRGB PNG (with the sRGB chunk that says so) in memory. Same image, same bytes: no date, no
/// program name. An image without pixels throws std::invalid_argument.
std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options = {});

/// The same as a file, whole or not at all. Throws OutputError.
void write_png(const std::filesystem::path& file, const Image& image, const PngOptions& options = {});

/// Any PNG as 8-bit sRGB RGBA. Throws InputError with the file's name if it can't be read, is no PNG, is
/// damaged in any byte up to its end mark, or has a side above 16,384 or more than 64 million pixels.
Image read_png(const std::filesystem::path& file);

/// The same from memory; `name` stands for the file in messages.
Image decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path& name);

}  // namespace unravel::render
