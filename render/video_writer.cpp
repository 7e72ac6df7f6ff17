#include <fmt/format.h>

#include <cerrno>

#include "base/whole_file.hpp"
#include "render/video.hpp"
#include "render/video_codecs.hpp"
#include "render/video_palette.hpp"

namespace unravel::render {
namespace {

void require_written(int result, const std::filesystem::path& file, const av::LogCapture& log) {
    // FFmpeg's own error numbers are tags far below the system's.
    if (result < 0 && result > -4096) throw OutputError(file, -result);
    if (result < 0) throw OutputError(file, log.explain(result));
}

}  // namespace

void check_video_settings(const std::filesystem::path& file, const VideoSettings& s) {
    const av::Container& container = av::container_for(file);
    if (container.even && (s.width % 2 != 0 || s.height % 2 != 0))
        throw VideoSettingsError(
            fmt::format("an {} of {} × {} pixels can't be made: width and height must be even, since "
                        "colour is stored for blocks of 2 × 2; .webm, .mkv and .gif take any size",
                        container.muxer, s.width, s.height));
    if (s.width < 16 || s.height < 16 || s.width > 16384 || s.height > 16384)
        throw VideoSettingsError(fmt::format(
            "a video of {} × {} pixels can't be made: each side must be 16 to 16384", s.width, s.height));
    if (s.fps_num < 1 || s.fps_den < 1 || s.fps_num > 1000 * static_cast<long long>(s.fps_den))
        throw VideoSettingsError(fmt::format("{}/{} frames a second can't be made: above 0 and at most 1000",
                                             s.fps_num, s.fps_den));
    // Its clock counts hundredths, and players slow a frame of one hundredth down to ten.
    if (std::string_view(container.muxer) == "gif" && s.fps_num > 50 * static_cast<long long>(s.fps_den))
        throw VideoSettingsError("a GIF shows at most 50 frames a second: lower fps or choose .mp4");
    if (s.alpha && std::string_view(container.muxer) != "matroska")
        throw VideoSettingsError("only .mkv keeps transparency here: choose it, or pictures without a video");
    if (s.threads < 1 || s.threads > 64) throw VideoSettingsError("the encoder's threads must be 1 to 64");
    // Opened for a moment: one that is not to be had is found out before anything is computed.
    av::choose_encoder(container, s);
}

struct VideoWriter::Parts {
    Parts(const std::filesystem::path& file, const VideoSettings& asked);

    void convert(const Image& image);
    void encode(const AVFrame* next);  // null: the encoder gives out what it still holds
    void finish();

    // Each is released before those above it.
    VideoSettings settings;
    const av::Container& container;
    av::OpenEncoder encoder;
    WholeFile whole;
    av::Io io;
    av::Muxer muxer;
    AVStream* stream = nullptr;  // the muxer's
    av::Scaler scaler;           // none for a GIF
    av::Frame frame;
    av::Packet packet;
    int count = 0;
};

VideoWriter::Parts::Parts(const std::filesystem::path& file, const VideoSettings& asked)
    : settings(asked),
      container(av::container_for(file)),
      encoder(av::choose_encoder(container, settings)),
      whole(file),
      frame(av::made<av::Frame>(av_frame_alloc())),
      packet(av::made<av::Packet>(av_packet_alloc())) {
    const av::LogCapture log;
    // "file:" keeps a colon in the name from being read as a protocol.
    const std::string url = "file:" + whole.temporary().string();
    AVIOContext* opened = nullptr;
    require_written(avio_open(&opened, url.c_str(), AVIO_FLAG_WRITE), file, log);
    io.reset(opened);
    AVFormatContext* made = nullptr;
    require_written(avformat_alloc_output_context2(&made, nullptr, container.muxer, url.c_str()), file, log);
    muxer.reset(made);
    muxer->pb = io.get();
    // No version of FFmpeg, no date and no random identifiers in the file.
    muxer->flags |= AVFMT_FLAG_BITEXACT;

    const AVCodecContext& context = *encoder.context;
    stream = avformat_new_stream(muxer.get(), nullptr);
    if (!stream) throw std::bad_alloc();
    require_written(avcodec_parameters_from_context(stream->codecpar, &context), file, log);
    stream->time_base = context.time_base;
    stream->avg_frame_rate = context.framerate;
    if (settings.faststart && std::string_view(container.muxer) == "mp4")
        av_opt_set(muxer->priv_data, "movflags", "+faststart", 0);
    require_written(avformat_write_header(muxer.get(), nullptr), file, log);

    frame->format = context.pix_fmt;
    frame->width = context.width;
    frame->height = context.height;
    frame->color_primaries = context.color_primaries;
    frame->color_trc = context.color_trc;
    frame->colorspace = context.colorspace;
    frame->color_range = context.color_range;
    frame->chroma_location = context.chroma_sample_location;
    frame->sample_aspect_ratio = context.sample_aspect_ratio;
    require_written(av_frame_get_buffer(frame.get(), 0), file, log);
    if (context.pix_fmt != AV_PIX_FMT_PAL8)
        scaler = av::make_converter(context.width, context.height,
                                    settings.alpha ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB0, context.pix_fmt);
}

void VideoWriter::Parts::convert(const Image& image) {
    if (!scaler) return av::fill_palette_frame(image, *frame);
    const std::uint8_t* rows[] = {image.pixels.data()};
    const int row_bytes[] = {4 * image.width};
    sws_scale(scaler.get(), rows, row_bytes, 0, image.height, frame->data, frame->linesize);
}

void VideoWriter::Parts::encode(const AVFrame* next) {
    const av::LogCapture log;
    require_written(avcodec_send_frame(encoder.context.get(), next), whole.target(), log);
    for (;;) {
        const int result = avcodec_receive_packet(encoder.context.get(), packet.get());
        if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
        require_written(result, whole.target(), log);
        // Some encoders leave this out, and some players then drop the last frame.
        if (packet->duration == 0) packet->duration = 1;
        // The muxer may have chosen another time base than it was asked for.
        av_packet_rescale_ts(packet.get(), encoder.context->time_base, stream->time_base);
        packet->stream_index = stream->index;
        require_written(av_interleaved_write_frame(muxer.get(), packet.get()), whole.target(), log);
    }
}

void VideoWriter::Parts::finish() {
    if (count == 0) return;
    encode(nullptr);
    const av::LogCapture log;
    require_written(av_write_trailer(muxer.get()), whole.target(), log);
    require_written(avio_close(io.release()), whole.target(), log);
    whole.commit();
}

VideoWriter::VideoWriter(const std::filesystem::path& file, const VideoSettings& settings) {
    check_video_settings(file, settings);
    parts_ = std::make_unique<Parts>(file, settings);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& image) {
    Parts& p = *parts_;
    if (image.width != p.settings.width || image.height != p.settings.height ||
        image.pixels.size() != static_cast<std::size_t>(image.width) * image.height * 4)
        throw std::invalid_argument(fmt::format("a frame of {} × {} pixels does not fit a video of {} × {}",
                                                image.width, image.height, p.settings.width,
                                                p.settings.height));
    // The encoder may still read the frame's memory of last time; then this gives it fresh memory.
    if (av_frame_make_writable(p.frame.get()) < 0) throw std::bad_alloc();
    p.convert(image);
    p.frame->pts = p.count;
    p.encode(p.frame.get());
    ++p.count;
}

void VideoWriter::finish() {
    parts_->finish();
}

int VideoWriter::frames() const {
    return parts_->count;
}

const std::string& VideoWriter::description() const {
    return parts_->encoder.description;
}

}  // namespace unravel::render
