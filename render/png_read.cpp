#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "base/whole_file.hpp"
#include "render/png.hpp"

namespace unravel::render {
namespace {

constexpr std::size_t max_file_bytes = std::size_t{512} << 20;
constexpr std::uint32_t max_side = 16384;
constexpr std::uint64_t max_pixels = std::uint64_t{64} << 20;
constexpr std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

std::uint32_t big_endian(const std::uint8_t* p) {
    return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

// Walks the chunks (length, type, data, CRC of type and data) from the signature to IEND. libpng stops
// reading at the last pixel it needs and so would let damage behind it pass.
void check_chunks(std::span<const std::uint8_t> bytes, const std::filesystem::path& name) {
    if (bytes.size() < signature.size() || !std::equal(signature.begin(), signature.end(), bytes.begin()))
        throw InputError(name, "it is not a PNG file");
    std::size_t at = signature.size();
    for (;;) {
        if (bytes.size() - at < 12) throw InputError(name, "the PNG file ends too early");
        const std::uint32_t length = big_endian(&bytes[at]);
        if (length > bytes.size() - at - 12)
            throw InputError(name, "the PNG file ends too early or is damaged");
        const std::string_view type(reinterpret_cast<const char*>(&bytes[at + 4]), 4);
        const auto sum = crc32(0, &bytes[at + 4], length + 4);
        if (sum != big_endian(&bytes[at + 8 + length]))
            throw InputError(name, fmt::format("the PNG file is damaged in the chunk at byte {}", at));
        if (type == "IEND") return;
        at += 12 + std::size_t{length};
    }
}

}  // namespace

Image decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path& name) {
    check_chunks(bytes, name);
    // libpng's simplified interface: errors come back as values, no longjmp passes through our frames.
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&header, png_image_free);
    if (!png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()))
        throw InputError(name, fmt::format("the PNG file is damaged ({})", header.message));
    if (header.width > max_side || header.height > max_side ||
        std::uint64_t{header.width} * header.height > max_pixels)
        throw InputError(name, fmt::format("{} × {} pixels are too many (at most {} a side and {} million)",
                                           header.width, header.height, max_side, max_pixels >> 20));
    header.format = PNG_FORMAT_RGBA;
    Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}};
    image.pixels.resize(PNG_IMAGE_SIZE(header));
    if (!png_image_finish_read(&header, nullptr, image.pixels.data(), 0, nullptr))
        throw InputError(name, fmt::format("the PNG file is damaged ({})", header.message));
    return image;
}

Image read_png(const std::filesystem::path& file) {
    return decode_png(read_whole_file(file, max_file_bytes), file);
}

}  // namespace unravel::render
