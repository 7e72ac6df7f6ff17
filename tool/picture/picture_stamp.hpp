#pragma once

#include <string>
#include <vector>

#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// All that a picture depends on besides the simulated frame: cameras, look, size, sampling and renderer. Two
/// runs with equal stamps draw the same bytes.
std::string picture_stamp(const Scene& scene, const ClipOptions& options, const std::string& renderer);

/// Makes the folder's pictures of a view those of a stamp. True: what lies there was drawn with this very
/// stamp and may be taken over. Otherwise, and where `whole_clip` is to be drawn, old pictures are removed
/// and the stamp is put there; where only a part of the clip is, old pictures stay but will never be taken
/// over. Throws OutputError.
bool keep_or_clear_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp,
                            bool whole_clip);

/// Frames first … last, drawn by a task of their own while others draw others into the same folder.
struct FrameRange {
    int first = 0, last = 0;
};

/// keep_or_clear_pictures() for a range, by a stamp of its own. The range's old pictures are removed.
bool keep_or_clear_range(const RunFolder& folder, const std::string& view, const std::string& stamp,
                         const FrameRange& range);

/// The stamp that vouches for a range's pictures, its own or the whole clip's; empty where there is none.
std::string stamp_of_range(const RunFolder& folder, const std::string& view, const FrameRange& range);

/// Before ranges are drawn: stamps stay only where they are `stamp` but for the renderer, and each vouches
/// for one of the ranges. Throws OutputError.
void keep_ranges(const RunFolder& folder, const std::string& view, const std::string& stamp,
                 const std::vector<FrameRange>& ranges);

/// A stamp's parts: all that the scene and the options decide, and the renderer.
std::string without_renderer(const std::string& stamp);
std::string renderer_in(const std::string& stamp);

}  // namespace unravel::tool
