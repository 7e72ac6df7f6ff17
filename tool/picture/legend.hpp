#pragma once

#include <memory>
#include <span>

#include "render/draw_scene.hpp"
#include "render/image.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/plot/canvas.hpp"

namespace unravel::tool {

/// What the colours of the component view mean, and the frame's numbers, in the lower left corner of its
/// pictures: of components the largest, with their sizes. On a page it is dark on white.
class Legend {
public:
    /// For pictures `height` pixels high, whose text is in proportion.
    Legend(const Scene& scene, int height);
    ~Legend();
    Legend(const Legend&) = delete;
    Legend& operator=(const Legend&) = delete;

    /// Draws it onto a picture, also a transparent one. `colors` (particles): by component.
    void add(const FrameRecord& record, std::span<const Rgb> colors, Image& picture);
    /// Draws it onto a page of this height.
    static void draw(const Scene& scene, const FrameRecord& record, std::span<const Rgb> colors, int height,
                     Canvas& canvas);

private:
    struct Page;
    std::unique_ptr<Page> page_;
};

}  // namespace unravel::tool
