#pragma once

#include "render/av.hpp"
#include "render/image.hpp"

namespace unravel::render::av {

/// Turns pictures into frames of 256 colours, the best for each picture alone, by FFmpeg's palettegen and
/// paletteuse. The same picture gives the same frame on every machine and whatever came before it.
class Quantizer {
public:
    /// For pictures of this size. Throws VideoError where this FFmpeg has no such filters.
    Quantizer(int width, int height);

    /// Fills a PAL8 frame of the pictures' size. The alpha is ignored.
    void fill(const Image& image, AVFrame& frame);

private:
    Graph graph_;
    AVFilterContext* source_ = nullptr;  // the graph's
    AVFilterContext* sink_ = nullptr;
    Frame picture_, result_;
    std::int64_t count_ = 0;
};

}  // namespace unravel::render::av
