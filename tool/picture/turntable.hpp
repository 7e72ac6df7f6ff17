#pragma once

#include "tool/base/names.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// Makes a clip's options those of one turn, `seconds` long, of all its cameras about one frame that stands
/// still. The last picture is one step short of the first, so that the video loops; cameras' own movement is
/// left out. Pictures and videos get the ending "_turntable".
void make_turntable(Scene& scene, ClipOptions& options, double seconds, int frame);

/// The frames of a turntable: `record` again and again, numbered from 0.
FrameSource turntable_source(const ClipOptions& options, const FrameRecord& record);

}  // namespace unravel::tool
