#include "render/video_palette.hpp"

#include <fmt/format.h>

#include <cstring>

#include "render/video.hpp"

namespace unravel::render::av {
namespace {

// A pattern that stands still: errors that spread (Floyd–Steinberg and its kin) crawl from frame to frame,
// and without any dithering the background's gradient has bands.
constexpr const char* chain =
    "[in]split[picture][counted];"
    "[counted]palettegen=stats_mode=single:reserve_transparent=0[palette];"
    "[picture][palette]paletteuse=new=1:dither=bayer:bayer_scale=4[out]";

void require_filtered(int result, const LogCapture& log) {
    if (result == AVERROR(ENOMEM)) throw std::bad_alloc();
    if (result < 0)
        throw VideoError(fmt::format("the palette of a GIF frame can't be made: {}", log.explain(result)));
}

struct Ends {
    AVFilterInOut* list;
    ~Ends() { avfilter_inout_free(&list); }
};

AVFilterInOut* end_of_chain(const char* name, AVFilterContext* filter) {
    AVFilterInOut* end = avfilter_inout_alloc();
    if (!end) throw std::bad_alloc();
    end->name = av_strdup(name);
    end->filter_ctx = filter;
    end->pad_idx = 0;
    end->next = nullptr;
    return end;
}

}  // namespace

Quantizer::Quantizer(int width, int height)
    : graph_(made<Graph>(avfilter_graph_alloc())),
      picture_(made<Frame>(av_frame_alloc())),
      result_(made<Frame>(av_frame_alloc())) {
    const LogCapture log;
    graph_->nb_threads = 1;
    const std::string form = fmt::format("video_size={}x{}:pix_fmt={}:time_base=1/1:pixel_aspect=1/1", width,
                                         height, av_get_pix_fmt_name(AV_PIX_FMT_0RGB32));
    require_filtered(avfilter_graph_create_filter(&source_, avfilter_get_by_name("buffer"), "in",
                                                  form.c_str(), nullptr, graph_.get()),
                     log);
    require_filtered(avfilter_graph_create_filter(&sink_, avfilter_get_by_name("buffersink"), "out", nullptr,
                                                  nullptr, graph_.get()),
                     log);
    // As the chain sees them: what goes into it comes out of the source.
    Ends outputs{end_of_chain("in", source_)}, inputs{end_of_chain("out", sink_)};
    require_filtered(avfilter_graph_parse_ptr(graph_.get(), chain, &inputs.list, &outputs.list, nullptr),
                     log);
    require_filtered(avfilter_graph_config(graph_.get(), nullptr), log);
    picture_->format = AV_PIX_FMT_0RGB32;
    picture_->width = width;
    picture_->height = height;
}

void Quantizer::fill(const Image& image, AVFrame& frame) {
    const LogCapture log;
    if (!picture_->data[0]) require_filtered(av_frame_get_buffer(picture_.get(), 0), log);
    require_filtered(av_frame_make_writable(picture_.get()), log);
    for (int y = 0; y < image.height; ++y) {
        auto* row = reinterpret_cast<std::uint32_t*>(picture_->data[0] +
                                                     static_cast<std::ptrdiff_t>(y) * picture_->linesize[0]);
        const std::uint8_t* from = image.at(0, y);
        for (int x = 0; x < image.width; ++x, from += 4)
            row[x] = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
    }
    picture_->pts = count_++;
    require_filtered(av_buffersrc_add_frame_flags(source_, picture_.get(), AV_BUFFERSRC_FLAG_KEEP_REF), log);
    require_filtered(av_buffersink_get_frame(sink_, result_.get()), log);
    for (int y = 0; y < image.height; ++y)
        std::memcpy(frame.data[0] + static_cast<std::ptrdiff_t>(y) * frame.linesize[0],
                    result_->data[0] + static_cast<std::ptrdiff_t>(y) * result_->linesize[0],
                    static_cast<std::size_t>(image.width));
    std::memcpy(frame.data[1], result_->data[1], AVPALETTE_SIZE);
    av_frame_unref(result_.get());
}

}  // namespace unravel::render::av
