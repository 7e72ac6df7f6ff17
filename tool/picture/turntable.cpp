#include "tool/picture/turntable.hpp"

#include <algorithm>
#include <cmath>

#include "tool/picture/view.hpp"

namespace unravel::tool {

void make_turntable(Scene& scene, ClipOptions& options, double seconds, int frame) {
    const double t = frame_time(scene, frame);
    for (Camera& camera : scene.cameras) {
        const CameraView view = camera_at(scene, camera, t);
        camera.position = view.position.cast<double>();
        camera.target = view.target.cast<double>();
        camera.keyframes.clear();
        // Where a solid had gone by then, the camera is now. A cloth's way is in the frame itself.
        if (std::ranges::any_of(scene.solids,
                                [&](const Solid& solid) { return solid.name == camera.follow; }))
            camera.follow.clear();
        camera.orbit = 360;
    }
    const int frames = std::max(1, static_cast<int>(std::lround(seconds * scene.clip.fps.per_second())));
    scene.clip.duration = scene.clip.fps.time_of(frames);
    options.first = 0;
    options.last = frames - 1;
    for (ClipView& view : options.views) view.name += "_turntable";
}

FrameSource turntable_source(const ClipOptions& options, const FrameRecord& record) {
    return [last = options.last, record = FrameRecord(record),
            next = 0]() mutable -> std::optional<FrameRecord> {
        if (next > last) return std::nullopt;
        record.frame = next++;
        return record;
    };
}

}  // namespace unravel::tool
