#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/file_errors.hpp"
#include "render/image.hpp"

namespace unravel::render {

/// The video's ending chooses the container: .mp4 (H.264), .webm (VP9), .mkv (lossless RGB), .gif (256
/// colours a frame). mp4 and webm are yuv420p (yuv444p where asked), limited range, BT.709, converted so and
/// tagged so. Players can jump to at least one frame in each second.
struct VideoSettings {
    int width = 1280, height = 720;  ///< 16 to 16,384; even in an .mp4
    int fps_num = 30, fps_den = 1;   ///< frames per second as a fraction
    std::string codec;               ///< an encoder's name; empty: the first of the container's that opens
    int crf = -1;             ///< constant quality, smaller is better; −1: the encoder's entry in our table
    bool thin_lines = false;  ///< pictures are of coloured wires: where no crf is asked, a better one
    bool full_chroma = false;  ///< colour for every pixel (4:4:4), where the encoder can: .mp4 and .webm
    std::string preset;        ///< effort, by the encoder's name for it; empty: a fast one
    int threads = 4;           ///< bytes depend on it, so it never follows the machine
    bool alpha = false;        ///< keep the frames' alpha; .mkv only
    bool faststart = true;     ///< mp4: index before the frames, so that it plays while it loads
};

/// No encoder that can do what was asked, or a setting that none can do. what() says what can be done
/// instead.
class VideoError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A size, a frame rate or an ending that no video can have, or a quality or effort that the encoder does not
/// know.
class VideoSettingsError : public VideoError {
public:
    using VideoError::VideoError;
};

/// Throws VideoSettingsError if no video can have this ending, size or frame rate, VideoError if no encoder
/// opens. To be asked before any frame is computed.
void check_video_settings(const std::filesystem::path& file, const VideoSettings& settings);

/// Writes a video of constant frame rate: the k-th image added is shown at exactly k fps_den / fps_num
/// seconds (to the container's resolution: mkv and webm 1 ms, gif 10 ms). Same images, same settings: same
/// bytes.
///
/// The file appears whole at finish() (base/whole_file.hpp); a writer that goes without it leaves nothing.
class VideoWriter {
public:
    /// Opens encoder and file. Throws VideoError, OutputError.
    VideoWriter(const std::filesystem::path& file, const VideoSettings& settings);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// Appends a frame; its alpha is ignored but where the settings keep it. Throws std::invalid_argument on
    /// another size than the video's, OutputError if the disk does not take it.
    void add(const Image& image);

    /// Encodes what is still in the encoder, ends the file and gives it its name. After any number of frames
    /// the file plays; without frames there is no file. Nothing may be added after it. Throws OutputError.
    void finish();

    int frames() const;

    /// The encoder taken and how it is set, on one line, and which were passed over and why.
    const std::string& description() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// One encoder that VideoWriter knows, tried on this machine.
struct EncoderVerdict {
    std::string ending;  ///< ".mp4"
    std::string codec;   ///< FFmpeg's name of the encoder
    bool opens = false;
    std::string reason;  ///< why it does not open
};

/// Every encoder VideoWriter would try, container by container in its order, really opened.
std::vector<EncoderVerdict> probe_encoders();

}  // namespace unravel::render
