#pragma once

#include <filesystem>

#include "render/draw_scene.hpp"
#include "render/gl_context.hpp"
#include "tool/base/names.hpp"
#include "tool/study/accuracy/accuracy.hpp"

namespace unravel::tool {

/// What the cheap answer looks like beside the accurate one.

/// One side of the picture.
struct AccuracySide {
    Trajectory trajectory;  ///< from frame 1 on
    std::string caption;
};

/// Colour of a particle that is `distance` m off, on a log scale over the three decades below `worst` m:
/// slate, blue, yellow, vermilion, told apart by every eye.
Rgb heat_color(double distance, double worst);

/// Both trajectories side by side as wires, the cheap one's particles coloured by how far they are from where
/// the accurate one has them, with captions, time and a scale. Half a second stands still at the end. Throws
/// RendererError, VideoError, OutputError.
///   keep_on  asked before each frame; false ends the video there
void write_accuracy_video(const Scene& scene, const AccuracySide& cheap, const AccuracySide& accurate,
                          const DeviceChoice& device, const std::filesystem::path& file,
                          const std::function<bool()>& keep_on);

}  // namespace unravel::tool
