#include "tool/picture/clip.hpp"

#include <tbb/parallel_pipeline.h>

#include <exception>

#include "tool/base/interrupt.hpp"
#include "tool/picture/studio.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

ClipReport make_clip(const Scene& scene, const ClothModel& model, const Placement& placement,
                     const RunFolder& folder, const ClipOptions& options, const FrameSource& source,
                     const std::function<void(int frame)>& done) {
    Studio studio(scene, model, placement, folder, options);
    std::exception_ptr stopped;  // by the source: what it has given is finished first

    const auto take = [&](tbb::flow_control& flow) -> Passage* {
        Passage* passage = nullptr;
        try {
            passage = studio.take(source);
        } catch (...) {
            stopped = std::current_exception();
        }
        if (!passage) flow.stop();
        return passage;
    };
    const auto draw = [&](Passage* passage) {
        studio.draw(*passage);
        return passage;
    };
    const auto write = [&](Passage* passage) {
        studio.write(*passage);
        return passage;
    };
    const auto encode = [&](Passage* passage) {
        studio.encode(*passage);
        const int frame = passage->record.frame;
        studio.release(passage);
        done(frame);
    };
    using tbb::filter_mode;
    tbb::parallel_pipeline(frames_under_way,
                           tbb::make_filter<void, Passage*>(filter_mode::serial_in_order, take) &
                               tbb::make_filter<Passage*, Passage*>(filter_mode::serial_in_order, draw) &
                               tbb::make_filter<Passage*, Passage*>(filter_mode::parallel, write) &
                               tbb::make_filter<Passage*, void>(filter_mode::serial_in_order, encode));
    ClipReport report = studio.finish(!stopped && !InterruptWatch::requested());
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
