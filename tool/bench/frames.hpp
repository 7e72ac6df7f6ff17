#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "render/gl_context.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A stage of the way from scene to videos, per frame.
struct FrameStage {
    std::string name;
    double wall = 0, cpu = 0;  ///< ms
};

/// What pictures of a scene cost, both views with PNG and mp4.
struct FrameBench {
    std::string renderer, encoder;
    int frames = 0, processors = 0;
    std::vector<FrameStage> stages;  ///< each alone, over all frames, before the next begins
    FrameStage together;             ///< all of them as `unravel run` does it
    double others = 0;               ///< processors that other programs kept busy meanwhile
    /// No pipeline is faster: its slowest stage, or all processors that were to be had busy with what all
    /// stages take.
    double bound() const;  ///< ms per frame
};

/// Measures each stage alone, then all together, over the scene's first `frames` frames. `folder`: for the
/// files, removed afterwards. Throws RendererError, VideoError, OutputError, SimulationError.
FrameBench bench_frames(const Scene& scene, int frames, int threads, const DeviceChoice& device,
                        const std::filesystem::path& folder);

/// The same as a table in text.
std::string frame_bench_text(const FrameBench& bench);

/// And as JSON.
nlohmann::ordered_json frame_bench_json(const FrameBench& bench);

}  // namespace unravel::tool
