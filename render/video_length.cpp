#include "render/video_length.hpp"

#include "render/av.hpp"

namespace unravel::render {

int count_video_frames(const std::filesystem::path& file) {
    const av::LogCapture log;
    AVFormatContext* opened = nullptr;
    if (avformat_open_input(&opened, ("file:" + file.string()).c_str(), nullptr, nullptr) < 0) return 0;
    const av::Demuxer demuxer(opened);
    const auto packet = av::made<av::Packet>(av_packet_alloc());
    int frames = 0;
    // There is one stream in what we write.
    while (av_read_frame(demuxer.get(), packet.get()) >= 0) {
        frames += packet->stream_index == 0 ? 1 : 0;
        av_packet_unref(packet.get());
    }
    return frames;
}

}  // namespace unravel::render
