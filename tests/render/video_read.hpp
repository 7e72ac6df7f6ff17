#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/file_errors.hpp"
#include "render/image.hpp"

namespace unravel::render {

/// What a video file says about itself. Names are FFmpeg's ("h264", "yuv420p", "bt709", "tv").
struct VideoFacts {
    std::string codec, pixel_format;
    std::string primaries, transfer, matrix, range;
    int width = 0, height = 0;
    double frames_per_second = 0;
    std::vector<int>
        keyframes;             ///< frames that can be jumped to, counted from 0; known once all were decoded
    bool index_first = false;  ///< mp4: the index (moov) lies before the frames (mdat)
};

/// Reads a video's facts and decodes it, calling `each` with every frame as RGB and the time in seconds at
/// which it is shown, in that order. Throws InputError with the file's name where it can't.
VideoFacts read_video(const std::filesystem::path& file,
                      const std::function<void(const Image&, double seconds)>& each = {});

}  // namespace unravel::render
