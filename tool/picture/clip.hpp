#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/gl_context.hpp"
#include "render/renderer.hpp"
#include "render/video.hpp"
#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/clip_view.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

/// Which pictures and videos a clip is to have.
struct ClipOptions {
    std::vector<ClipView> views{{Layout::textured, 0, "textured"}, {Layout::components, 0, "components"}};
    DeviceChoice device;
    std::filesystem::path textures;  ///< folder that the scene's pictures are named relative to
    int samples = 0;                 ///< see RenderSettings
    int supersample = 1;
    Quality quality = Quality::standard;  ///< of textured pictures
    int first = 0;                        ///< frames drawn: first … last
    int last = 0;
    std::string video_ending = ".mp4";  ///< empty: no videos
    std::string codec, preset;
    int crf = -1;
    bool full_chroma = false;  ///< see VideoSettings
    std::string format;        ///< svg, pdf: the first frame's component view as such a file, no picture else
    bool reuse_pictures = false;  ///< frames whose picture lies there already are read, not drawn
    bool keep_pictures = true;    ///< write PNG frames
    bool shares_folder = false;   ///< other ranges of frames are drawn into the folder at the same time
    bool vouched = false;         ///< what lies there is this clip's: its stamp is not asked for
    bool keep_longer = true;      ///< a part of a clip does not replace a video of more frames
    /// Called with every finished picture, by several threads at once; empty: nobody looks.
    std::function<void(const ClipView& view, int frame, const Image& picture)> picture;
};

/// What became of it.
struct ClipReport {
    std::string renderer, renderer_summary;
    bool software = true;
    std::vector<std::string> encoders;  ///< a line per video
    std::vector<std::string> videos;    ///< file names
    int frames = 0;                     ///< finished
    std::string kept;                   ///< in words: what was there before and has stayed; empty: nothing
    double draw = 0, write = 0, encode = 0;  ///< s spent in each stage
};

/// Gives the next frame, in order, or nothing at the end of the clip or when the run is to stop.
using FrameSource = std::function<std::optional<FrameRecord>()>;

/// Draws, writes and encodes the frames that `source` gives, while it works on the next ones: a pipeline of
/// source → draw → PNG → video, each frame in at most one of them. One thread owns the GL context for life; a
/// frame waits in memory only while a stage is ahead of the next. Videos are finished also where the source
/// ends early or throws, so that they play as far as they got; what the source threw is thrown on. `done` is
/// called after each finished frame, in order. Pictures of another look and longer videos are replaced only
/// once what replaces them is whole: until then it is drawn beside them, in next/.
ClipReport make_clip(const Scene& scene, const ClothModel& model, const Placement& placement,
                     const RunFolder& folder, const ClipOptions& options, const FrameSource& source,
                     const std::function<void(int frame)>& done);

/// Opens and closes renderer and encoders as make_clip() would: what is missing is said before any step is
/// computed. Throws RendererError, VideoError.
void check_clip(const Scene& scene, const RunFolder& folder, const ClipOptions& options);

}  // namespace unravel::tool
