#include "tests/render/video_read.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <array>
#include <cstring>
#include <fstream>

#include "render/av.hpp"

namespace unravel::render {
namespace {

std::string named(const char* name) {
    return name ? name : "unknown";
}

// An mp4 file is a row of boxes: 4 bytes of length (1: the length follows in 8 bytes), 4 of type.
bool index_first(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    for (std::array<unsigned char, 16> head{}; in.read(reinterpret_cast<char*>(head.data()), 8);) {
        const std::string_view type(reinterpret_cast<const char*>(&head[4]), 4);
        if (type == "moov") return true;
        if (type == "mdat") return false;
        std::uint64_t length = 0;
        for (int i = 0; i < 4; ++i) length = length << 8 | head[i];
        if (length < 8) return false;
        in.seekg(static_cast<std::streamoff>(length - 8), std::ios::cur);
    }
    return false;
}

void require_read(int result, const std::filesystem::path& file, const av::LogCapture& log) {
    if (result < 0) throw InputError(file, log.explain(result));
}

VideoFacts facts_of(const AVStream& stream, const std::filesystem::path& file) {
    const AVCodecParameters& p = *stream.codecpar;
    VideoFacts facts;
    facts.codec = avcodec_get_name(p.codec_id);
    facts.pixel_format = named(av_get_pix_fmt_name(static_cast<AVPixelFormat>(p.format)));
    facts.primaries = named(av_color_primaries_name(p.color_primaries));
    facts.transfer = named(av_color_transfer_name(p.color_trc));
    facts.matrix = named(av_color_space_name(p.color_space));
    facts.range = named(av_color_range_name(p.color_range));
    facts.width = p.width;
    facts.height = p.height;
    facts.frames_per_second = av_q2d(stream.avg_frame_rate);
    facts.index_first = index_first(file);
    return facts;
}

// Gives out what the decoder has ready, as RGB.
class Frames {
public:
    Frames(const AVStream& stream, const std::function<void(const Image&, double)>& each)
        : time_base_(stream.time_base), each_(each), frame_(av::made<av::Frame>(av_frame_alloc())) {}

    // 0 or FFmpeg's error.
    int drain(AVCodecContext& decoder) {
        for (;;) {
            const int result = avcodec_receive_frame(&decoder, frame_.get());
            if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return 0;
            if (result < 0) return result;
            const int width = frame_->width, height = frame_->height;
            if (!scaler_) {
                // As a player does: by the file's own tag.
                scaler_ = av::make_converter(width, height, static_cast<AVPixelFormat>(frame_->format),
                                             AV_PIX_FMT_RGBA, frame_->colorspace);
                image_ = {width, height, {}};
                image_.pixels.resize(static_cast<std::size_t>(width) * height * 4);
            }
            if (width != image_.width || height != image_.height) return AVERROR_INPUT_CHANGED;
            std::uint8_t* rows[] = {image_.pixels.data()};
            const int row_bytes[] = {4 * width};
            sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, height, rows, row_bytes);
            each_(image_, static_cast<double>(frame_->best_effort_timestamp) * av_q2d(time_base_));
        }
    }

private:
    AVRational time_base_;
    const std::function<void(const Image&, double)>& each_;
    av::Frame frame_;
    av::Scaler scaler_;
    Image image_;
};

}  // namespace

VideoFacts read_video(const std::filesystem::path& file,
                      const std::function<void(const Image&, double)>& each) {
    const av::LogCapture log;
    AVFormatContext* opened = nullptr;
    require_read(avformat_open_input(&opened, ("file:" + file.string()).c_str(), nullptr, nullptr), file,
                 log);
    const av::Demuxer demuxer(opened);
    require_read(avformat_find_stream_info(demuxer.get(), nullptr), file, log);
    const AVCodec* codec = nullptr;
    const int index = av_find_best_stream(demuxer.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    require_read(index, file, log);
    const AVStream& stream = *demuxer->streams[index];
    VideoFacts facts = facts_of(stream, file);
    if (!each) return facts;

    const auto decoder = av::made<av::Codec>(avcodec_alloc_context3(codec));
    require_read(avcodec_parameters_to_context(decoder.get(), stream.codecpar), file, log);
    decoder->pkt_timebase = stream.time_base;
    require_read(avcodec_open2(decoder.get(), codec, nullptr), file, log);
    const auto packet = av::made<av::Packet>(av_packet_alloc());
    Frames frames(stream, each);
    int result = 0, packets = 0;
    while ((result = av_read_frame(demuxer.get(), packet.get())) >= 0) {
        if (packet->stream_index == index) {
            // Nothing is shown across a keyframe of these codecs: as many frames go before it as packets do.
            if (packet->flags & AV_PKT_FLAG_KEY) facts.keyframes.push_back(packets);
            ++packets;
            require_read(avcodec_send_packet(decoder.get(), packet.get()), file, log);
            require_read(frames.drain(*decoder), file, log);
        }
        av_packet_unref(packet.get());
    }
    if (result != AVERROR_EOF) require_read(result, file, log);
    require_read(avcodec_send_packet(decoder.get(), nullptr), file, log);
    require_read(frames.drain(*decoder), file, log);
    return facts;
}

}  // namespace unravel::render
