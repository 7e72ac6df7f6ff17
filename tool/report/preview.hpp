#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "base/disk_buffer.hpp"
#include "render/image.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// The picture, smaller: every pixel the mean of those it stands for, in linear light. `width` not above the
/// picture's own; the height keeps the shape.
Image shrink(const Image& image, int width);

/// A lossy WebP file in memory. Throws std::runtime_error where the encoder fails.
std::vector<std::uint8_t> encode_webp(const Image& image, float quality = 80);

/// "UklGR…" as data: URIs have it.
std::string base64(const std::vector<std::uint8_t>& bytes);

/// Small pictures of a clip for its page, made as frames pass by. Their size follows from the number of
/// frames, so that all together stay within a budget. They wait on the disk.
class Previews {
public:
    /// `pictures` of width × height are to come; together they may take `budget` bytes. They wait in the file
    /// system of `folder`.
    Previews(int width, int height, int pictures, std::size_t budget, const std::filesystem::path& folder);

    /// May be called from several threads.
    void add(const std::string& view, int frame, const Image& image);

    /// Those that there are of a view, in order.
    std::vector<int> frames(const std::string& view) const;
    /// One of them, as base64 WebP.
    std::string text(const std::string& view, int frame) const;
    std::size_t bytes() const { return bytes_; }
    bool within_budget() const { return bytes_ <= budget_; }
    int width() const { return width_; }

private:
    int width_;
    std::size_t budget_, share_, bytes_ = 0;
    std::mutex mutex_;
    struct Place {
        std::uint64_t begin = 0;
        std::size_t size = 0;
    };
    DiskBuffer buffer_;
    std::map<std::string, std::map<int, Place>> pictures_;
};

}  // namespace unravel::tool
