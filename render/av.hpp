#pragma once

// FFmpeg's C objects with their owners. Included by the video sources only.

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <memory>
#include <string>

namespace unravel::render::av {

struct Delete {
    void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
    void operator()(AVFrame* p) const { av_frame_free(&p); }
    void operator()(AVPacket* p) const { av_packet_free(&p); }
    void operator()(AVIOContext* p) const { avio_close(p); }
    void operator()(SwsContext* p) const { sws_freeContext(p); }
    void operator()(AVFilterGraph* p) const { avfilter_graph_free(&p); }
};
struct DeleteMuxer {
    void operator()(AVFormatContext* p) const { avformat_free_context(p); }
};
struct DeleteDemuxer {
    void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};

using Codec = std::unique_ptr<AVCodecContext, Delete>;
using Frame = std::unique_ptr<AVFrame, Delete>;
using Packet = std::unique_ptr<AVPacket, Delete>;
using Io = std::unique_ptr<AVIOContext, Delete>;
using Graph = std::unique_ptr<AVFilterGraph, Delete>;
using Scaler = std::unique_ptr<SwsContext, Delete>;
using Muxer = std::unique_ptr<AVFormatContext, DeleteMuxer>;
using Demuxer = std::unique_ptr<AVFormatContext, DeleteDemuxer>;

/// The object just made, or std::bad_alloc where FFmpeg returned none.
template <typename Owner>
Owner made(typename Owner::pointer object) {
    if (!object) throw std::bad_alloc();
    return Owner(object);
}

/// FFmpeg's error number in words.
std::string error_text(int error);

/// While one lives, FFmpeg's error messages made on this thread are collected here; all other messages of
/// FFmpeg are dropped from the first LogCapture on, since a terminal that shows progress has no room for
/// them.
class LogCapture {
public:
    LogCapture();
    ~LogCapture();
    LogCapture(const LogCapture&) = delete;
    LogCapture& operator=(const LogCapture&) = delete;

    /// `error` in words, after it what FFmpeg said about it.
    std::string explain(int error) const;

private:
    std::string text_;
    std::string* outer_;
};

/// A converter between two formats of one size, with every rounding and filter choice made for accuracy and
/// repeatability. YUV is limited range with chroma sited left, RGB is full range.
Scaler make_converter(int width, int height, AVPixelFormat from, AVPixelFormat to,
                      AVColorSpace yuv = AVCOL_SPC_BT709);

}  // namespace unravel::render::av
