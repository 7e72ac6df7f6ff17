#pragma once

#include <memory>

#include "render/image.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// What the colours of the component view mean, and the frame's numbers, in the lower left corner of its
/// pictures.
class Legend {
public:
    /// For pictures `height` pixels high, whose text is in proportion.
    Legend(const Scene& scene, int height);
    ~Legend();
    Legend(const Legend&) = delete;
    Legend& operator=(const Legend&) = delete;

    /// Draws it onto a picture, also a transparent one.
    void add(const FrameRecord& record, Image& picture);

private:
    struct Page;
    std::unique_ptr<Page> page_;
};

}  // namespace unravel::tool
