#pragma once

#include "render/av.hpp"
#include "render/image.hpp"

namespace unravel::render::av {

/// Fills a PAL8 frame of the image's size with the best 256 colours for this image alone, dithered. The alpha
/// is ignored.
void fill_palette_frame(const Image& image, AVFrame& frame);

}  // namespace unravel::render::av
