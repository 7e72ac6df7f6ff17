#pragma once

#include <vector>

#include "render/gl_context.hpp"
#include "sim/run/frame_record.hpp"
#include "tool/base/names.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

/// One frame drawn as textured and as components view, in that order, outside any clip. `colors` (particles).
/// Throws RendererError.
std::vector<Image> draw_still(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                              const std::vector<Rgb>& colors, const DeviceChoice& device);

}  // namespace unravel::tool
