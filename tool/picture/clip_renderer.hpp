#pragma once

#include <tbb/concurrent_queue.h>

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "render/palette.hpp"
#include "render/renderer.hpp"
#include "tool/base/names.hpp"
#include "tool/picture/clip.hpp"
#include "tool/picture/figure.hpp"
#include "tool/picture/legend.hpp"
#include "tool/picture/render_thread.hpp"

namespace unravel::tool {

/// Frames between source and end of the pipeline at any time: one per stage and one to take up unevenness.
inline constexpr std::size_t frames_in_flight = 5;

/// A frame on its way. Reused, so that a long clip allocates no more than a short one.
struct FrameInFlight {
    FrameRecord record;
    std::vector<DrawFrame> exposures;
    DrawFrame still;              ///< the frame itself, where component views are not drawn of its exposures
    std::vector<Rgb> colors;      ///< (particles) by component
    std::vector<Image> pictures;  ///< (views)
    std::vector<Image> parts;     ///< (shots) drawn for a view of several, where no view is that shot alone
};

/// Context and renderer, made, used and destroyed on the thread that owns them.
class RendererOnThread {
public:
    /// `scene` must outlive it. Throws RendererError.
    RendererOnThread(const DrawScene& scene, const DeviceChoice& device, const RenderSettings& settings);
    ~RendererOnThread();
    RendererOnThread(const RendererOnThread&) = delete;
    RendererOnThread& operator=(const RendererOnThread&) = delete;

    /// Does `work` on the thread and waits for it; what it throws is thrown here.
    void run(std::function<void()> work) { thread_.run(std::move(work)); }
    const GlContext& context() const { return *context_; }
    Renderer& renderer() { return *renderer_; }

private:
    RenderThread thread_;
    std::unique_ptr<GlContext> context_;
    std::unique_ptr<Renderer> renderer_;
};

/// Everything between a frame record and its files: the stages of make_clip()'s pipeline. Stages of one frame
/// follow each other; each stage but write() works on one frame at a time.
class ClipRenderer {
public:
    ClipRenderer(const Scene& scene, const ClothModel& model, const Placement& placement,
                 const RunFolder& folder, const ClipOptions& options);
    ClipRenderer(const ClipRenderer&) = delete;
    ClipRenderer& operator=(const ClipRenderer&) = delete;

    FrameInFlight* take(const FrameSource& source);  ///< null: the clip is over
    void draw(FrameInFlight& slot);
    void write(FrameInFlight& slot);
    void encode(FrameInFlight& slot);
    void release(FrameInFlight* slot);
    /// `ended`: the clip came to its end, and was not stopped on the way.
    ClipReport finish(bool ended);

private:
    void plan_shots();
    void choose_folder();
    void prepare_folders();
    bool draws_whole_clip() const;
    void finish_video(std::size_t view, bool all);
    void adopt();
    void remember(const FrameRecord& record);
    bool lies_there(const FrameInFlight& slot, std::size_t view) const;
    bool take_over(const FrameInFlight& slot, std::size_t view, Image& picture) const;
    Image& image_of(FrameInFlight& slot, std::size_t shot) const;
    void draw_shot(FrameInFlight& slot, std::size_t shot);
    void draw_still(FrameInFlight& slot, std::size_t shot);
    int exposures() const;
    bool of_still(DrawStyle style) const;
    void compose(FrameInFlight& slot, std::size_t view) const;

    const Scene& scene_;
    const ClothModel& model_;
    const RunFolder target_;  // where the clip belongs
    RunFolder folder_;        // where it is drawn
    const ClipOptions& options_;
    std::vector<Shot> shots_;     // each drawn once a frame
    std::vector<int> shot_view_;  // (shots) the view that is this shot alone; −1: none
    std::vector<std::vector<std::size_t>> view_shots_;  // (views)
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<char> reusable_;  // (views) pictures that lie there may be taken over
    ComponentColors colors_;
    SteadyColors steady_;
    ClothState previous_;  // of the frame before, where pictures are blurred by motion
    bool has_previous_ = false;
    DrawScene drawn_;
    RendererOnThread drawing_;
    std::unique_ptr<Legend> legend_;       // used on its thread
    std::unique_ptr<PaperFigure> figure_;  // where component views are figures on a page
    std::vector<std::unique_ptr<VideoWriter>> videos_;
    std::array<FrameInFlight, frames_in_flight> in_flight_;
    tbb::concurrent_bounded_queue<FrameInFlight*> free_;
    std::mutex mutex_;  // of report_.write: pictures are written by several tasks at once
    ClipReport report_;
};

/// The encoder's settings for a view of these options.
VideoSettings video_settings(const Scene& scene, const ClipOptions& options, Layout layout);

}  // namespace unravel::tool
