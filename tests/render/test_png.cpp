#include <zlib.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <random>
#include <string>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "tests/base/temporary_folder.hpp"

using namespace unravel;
using namespace unravel::render;

namespace {

Image random_image(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Image image{width, height, {}};
    image.pixels.resize(static_cast<std::size_t>(width) * height * 4);
    std::generate(image.pixels.begin(), image.pixels.end(),
                  [&] { return static_cast<std::uint8_t>(random()); });
    return image;
}

bool has_chunk(const std::vector<std::uint8_t>& png, const std::string& type) {
    return std::search(png.begin(), png.end(), type.begin(), type.end()) != png.end();
}

// An IHDR chunk that claims a size, with a right checksum, and nothing else.
std::vector<std::uint8_t> header_only(std::uint32_t width, std::uint32_t height) {
    auto bytes = encode_png(random_image(1, 1, 1));
    for (int i = 0; i < 4; ++i) {
        bytes[16 + i] = static_cast<std::uint8_t>(width >> (24 - 8 * i));
        bytes[20 + i] = static_cast<std::uint8_t>(height >> (24 - 8 * i));
    }
    const auto sum = crc32(0, &bytes[12], 17);
    for (int i = 0; i < 4; ++i) bytes[29 + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    return bytes;
}

}  // namespace

TEST_CASE("png_round_trips_every_pixel") {
    const TemporaryFolder folder;
    const int sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {33, 17}, {640, 361}};
    for (const auto& size : sizes)
        for (int level : {1, 3, 9}) {
            INFO(size[0] << " × " << size[1] << ", level " << level);
            Image image = random_image(size[0], size[1], 7);
            write_png(folder / "rgba.png", image, {level, true});
            CHECK(read_png(folder / "rgba.png").pixels == image.pixels);
            write_png(folder / "rgb.png", image, {level, false});
            const Image back = read_png(folder / "rgb.png");
            for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 255;
            CHECK(back.width == image.width);
            CHECK(back.height == image.height);
            CHECK(back.pixels == image.pixels);
        }
    CHECK(folder.entries() == 2);
}

TEST_CASE("png_says_srgb_and_nothing_that_varies_between_runs") {
    const Image image = random_image(40, 30, 3);
    const auto bytes = encode_png(image);
    CHECK(bytes == encode_png(image));
    CHECK(has_chunk(bytes, "sRGB"));
    for (const char* type : {"tIME", "tEXt", "gAMA", "iCCP"}) CHECK_FALSE(has_chunk(bytes, type));
}

TEST_CASE("an_image_without_pixels_or_with_too_few_is_no_png") {
    CHECK_THROWS_AS(encode_png(Image{}), std::invalid_argument);
    CHECK_THROWS_AS(encode_png(Image{2, 2, std::vector<std::uint8_t>(15)}), std::invalid_argument);
}

TEST_CASE("a_png_cut_short_anywhere_is_refused") {
    const auto bytes = encode_png(random_image(19, 11, 5));
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        INFO("first " << length << " bytes");
        CHECK_THROWS_AS(decode_png(std::span(bytes).first(length), "cut.png"), InputError);
    }
}

TEST_CASE("a_png_with_any_byte_changed_is_refused") {
    const auto bytes = encode_png(random_image(13, 9, 6));
    for (std::size_t at = 0; at < bytes.size(); ++at)
        for (int bit : {0, 7}) {
            auto damaged = bytes;
            damaged[at] ^= static_cast<std::uint8_t>(1 << bit);
            INFO("byte " << at << ", bit " << bit);
            CHECK_THROWS_AS(decode_png(damaged, "flipped.png"), InputError);
        }
}

TEST_CASE("png_errors_name_the_file_and_what_is_wrong_with_it") {
    const TemporaryFolder folder;
    const auto bytes = encode_png(random_image(8, 8, 2));
    write_whole_file(folder / "text.png", "not a picture at all");
    CHECK_THROWS_WITH(read_png(folder / "text.png"), Catch::Contains("text.png: it is not a PNG file"));
    write_whole_file(folder / "cut.png", std::span(bytes).first(bytes.size() - 5));
    CHECK_THROWS_WITH(read_png(folder / "cut.png"), Catch::Contains("cut.png: the PNG file ends too early"));
    CHECK_THROWS_WITH(read_png(folder / "none.png"), Catch::Contains("none.png: No such file"));
    // Sizes are refused from the header, before memory is taken for them.
    CHECK_THROWS_WITH(decode_png(header_only(20000, 1), "wide.png"),
                      Catch::Contains("20000 × 1 pixels are too many"));
    CHECK_THROWS_WITH(decode_png(header_only(16000, 16000), "big.png"), Catch::Contains("too many"));
    // A size that its data do not fill.
    CHECK_THROWS_WITH(decode_png(header_only(100, 100), "hollow.png"), Catch::Contains("damaged"));
}
