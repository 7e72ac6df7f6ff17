#include "render/video_palette.hpp"

#include <libimagequant.h>
#include <omp.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

namespace unravel::render::av {
namespace {

struct Release {
    void operator()(liq_attr* p) const { liq_attr_destroy(p); }
    void operator()(liq_image* p) const { liq_image_destroy(p); }
    void operator()(liq_result* p) const { liq_result_destroy(p); }
};

void opaque_row(liq_color* row, int y, int width, void* user) {
    const auto& image = *static_cast<const Image*>(user);
    std::memcpy(row, image.at(0, y), static_cast<std::size_t>(width) * 4);
    for (int x = 0; x < width; ++x) row[x].a = 255;
}

void require(bool fine) {
    if (!fine) throw std::runtime_error("the palette of a GIF frame could not be made (libimagequant)");
}

}  // namespace

void fill_palette_frame(const Image& image, AVFrame& frame) {
    // Its sums, and so its palettes, depend on how many threads share them. The setting is this thread's
    // alone.
    omp_set_num_threads(1);
    const std::unique_ptr<liq_attr, Release> attributes(liq_attr_create());
    require(attributes != nullptr);
    liq_set_speed(attributes.get(), 7);  // of 1 to 10: beyond 5 the palette hardly changes, the time halves
    const std::unique_ptr<liq_image, Release> source(liq_image_create_custom(
        attributes.get(), opaque_row, const_cast<Image*>(&image), image.width, image.height, 0));
    require(source != nullptr);
    liq_result* quantized = nullptr;
    require(liq_image_quantize(source.get(), attributes.get(), &quantized) == LIQ_OK);
    const std::unique_ptr<liq_result, Release> result(quantized);
    // Full dithering crawls from frame to frame, none shows bands in the background's gradient.
    liq_set_dithering_level(result.get(), 0.5F);

    std::vector<unsigned char*> rows(static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y)
        rows[static_cast<std::size_t>(y)] =
            frame.data[0] + static_cast<std::ptrdiff_t>(y) * frame.linesize[0];
    require(liq_write_remapped_image_rows(result.get(), source.get(), rows.data()) == LIQ_OK);

    const liq_palette& palette = *liq_get_palette(result.get());
    auto* entries = reinterpret_cast<std::uint32_t*>(frame.data[1]);
    std::fill(entries, entries + AVPALETTE_COUNT, 0xff000000U);
    for (unsigned i = 0; i < palette.count; ++i) {
        const liq_color& c = palette.entries[i];
        entries[i] = 0xff000000U | std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b;
    }
}

}  // namespace unravel::render::av
