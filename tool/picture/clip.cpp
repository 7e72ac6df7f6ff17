#include "tool/picture/clip.hpp"

#include <tbb/parallel_pipeline.h>

#include <exception>

#include "tool/base/interrupt.hpp"
#include "tool/picture/clip_renderer.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

ClipReport make_clip(const Scene& scene, const ClothModel& model, const Placement& placement,
                     const RunFolder& folder, const ClipOptions& options, const FrameSource& source,
                     const std::function<void(int frame)>& done) {
    ClipRenderer clip(scene, model, placement, folder, options);
    std::exception_ptr stopped;  // by the source: what it has given is finished first

    const auto take = [&](tbb::flow_control& flow) -> FrameInFlight* {
        FrameInFlight* slot = nullptr;
        try {
            slot = clip.take(source);
        } catch (...) {
            stopped = std::current_exception();
        }
        if (!slot) flow.stop();
        return slot;
    };
    const auto draw = [&](FrameInFlight* slot) {
        clip.draw(*slot);
        return slot;
    };
    const auto write = [&](FrameInFlight* slot) {
        clip.write(*slot);
        return slot;
    };
    const auto encode = [&](FrameInFlight* slot) {
        clip.encode(*slot);
        const int frame = slot->record.frame;
        clip.release(slot);
        done(frame);
    };
    using tbb::filter_mode;
    tbb::parallel_pipeline(
        frames_in_flight,
        tbb::make_filter<void, FrameInFlight*>(filter_mode::serial_in_order, take) &
            tbb::make_filter<FrameInFlight*, FrameInFlight*>(filter_mode::serial_in_order, draw) &
            tbb::make_filter<FrameInFlight*, FrameInFlight*>(filter_mode::parallel, write) &
            tbb::make_filter<FrameInFlight*, void>(filter_mode::serial_in_order, encode));
    ClipReport report = clip.finish(!stopped && !InterruptWatch::requested());
    if (stopped) std::rethrow_exception(stopped);
    return report;
}

void check_clip(const Scene& scene, const RunFolder& folder, const ClipOptions& options) {
    if (!options.video_ending.empty()) {
        for (const ClipView& view : options.views)
            check_video_settings(folder.video(view.name, options.video_ending),
                                 video_settings(scene, options, view.layout));
    }
    if (!options.textures.empty()) check_textures(scene, options.textures);
    const GlContext context(options.device);
}

}  // namespace unravel::tool
