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

/// Whether the folder has pictures of a view that were drawn otherwise than with this stamp.
bool holds_other_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp);

/// How many pictures of a view there are.
int count_pictures(const RunFolder& folder, const std::string& view);

/// Makes the folder's pictures of a view those of a stamp. True: what lies there was drawn with this very
/// stamp and may be taken over. Otherwise the stamp is put there where `whole_clip` is to be drawn; old
/// pictures stay, but will never be taken over. Throws OutputError.
bool stamp_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp,
                    bool whole_clip);

/// Puts a whole clip's pictures of a view, drawn into another folder, in the place of those of a folder.
/// Throws OutputError.
void adopt_pictures(const RunFolder& from, const RunFolder& to, const std::string& view);

/// Removes a view's pictures beyond a whole clip's last frame: they are of one that was longer.
void remove_pictures_beyond(const RunFolder& folder, const std::string& view, int last);

/// Frames first … last, drawn by a task of their own while others draw others into the same folder.
struct FrameRange {
    int first = 0, last = 0;
};

/// stamp_pictures() for a range, by a stamp of its own. The range's old pictures are removed.
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
