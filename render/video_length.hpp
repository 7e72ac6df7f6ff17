#pragma once

#include <filesystem>

namespace unravel::render {

/// Frames that a video holds, without decoding them; 0 where it can't be read.
int count_video_frames(const std::filesystem::path& file);

}  // namespace unravel::render
