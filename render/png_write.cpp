#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string>

#include "base/whole_file.hpp"
#include "render/png.hpp"

namespace unravel::render {
namespace {

// What libpng's callbacks see. The message is a plain array, since libpng leaves its functions by longjmp,
// which runs no destructors.
struct EncodeJob {
    std::vector<std::uint8_t> bytes;
    char message[160] = "";
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* job = static_cast<EncodeJob*>(png_get_error_ptr(png));
    std::snprintf(job->message, sizeof job->message, "%s", message);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void append_bytes(png_structp png, png_bytep data, png_size_t size) {
    auto& bytes = static_cast<EncodeJob*>(png_get_io_ptr(png))->bytes;
    bool full = false;
    try {
        bytes.insert(bytes.end(), data, data + size);
    } catch (const std::bad_alloc&) {
        full =
            true;  // png_error() must not be called from in here: it would jump over the exception's release
    }
    if (full) png_error(png, "out of memory");
}

struct PngWriter {
    explicit PngWriter(EncodeJob& job)
        : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning)),
          info(png ? png_create_info_struct(png) : nullptr) {}
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    png_structp png;
    png_infop info;
};

// False with job.message set if libpng gave up. Only plain values live here, for the sake of longjmp.
bool encode(png_structp png, png_infop info, EncodeJob& job, const Image& image, const PngOptions& options) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &job, append_bytes, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 options.alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    // Trying all filters on each row costs several times the compression itself and saves next to nothing
    // here.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_level(png, options.level);
    png_set_compression_buffer_size(png, 1 << 18);
    png_write_info(png, info);
    if (!options.alpha) png_set_filler(png, 0, PNG_FILLER_AFTER);  // drops every fourth byte
    for (int y = 0; y < image.height; ++y) png_write_row(png, image.at(0, y));
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options) {
    if (image.width <= 0 || image.height <= 0 ||
        image.pixels.size() != static_cast<std::size_t>(image.width) * image.height * 4)
        throw std::invalid_argument(
            "an image for a PNG needs width × height × 4 bytes and at least one pixel");
    EncodeJob job;
    job.bytes.reserve(image.pixels.size() / 4);
    PngWriter writer(job);
    if (!writer.info) throw std::bad_alloc();
    if (!encode(writer.png, writer.info, job, image, options))
        throw std::runtime_error(std::string("can't make a PNG: ") + job.message);
    return std::move(job.bytes);
}

void write_png(const std::filesystem::path& file, const Image& image, const PngOptions& options) {
    write_whole_file(file, encode_png(image, options));
}

}  // namespace unravel::render
