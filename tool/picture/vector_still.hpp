#pragma once

#include <filesystem>
#include <functional>

#include "tool/base/names.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// Writes the component view of frame `options.first` by its first view's camera as a figure in a vector file
/// of format `options.format` ("svg" or "pdf"), beside where its pictures go; no renderer is needed. `read`
/// gives the frames of the clip, asked for from 0 on: colours follow components through time, and are this
/// frame's own at once, not once they have held for a while, as in a clip. Returns the file. Throws
/// OutputError.
std::filesystem::path write_vector_still(const Scene& scene, const ClothModel& model,
                                         const Placement& placement, const RunFolder& folder,
                                         const ClipOptions& options,
                                         const std::function<FrameRecord(int frame)>& read);

}  // namespace unravel::tool
