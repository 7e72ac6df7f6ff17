#pragma once

#include <array>

#include "render/gl_objects.hpp"
#include "render/image.hpp"

namespace unravel::render {

/// Brings finished frames to memory through a ring of pixel buffers, so that a GPU can draw the next frame
/// while the last one travels.
class Readback {
public:
    static constexpr int depth = 3;  ///< frames that may be under way

    Readback(int width, int height);

    int pending() const { return pending_; }
    /// Asks for the framebuffer bound for reading. At most `depth` may be under way.
    void start();
    /// Waits for the oldest frame and turns it the right way up: top row first.
    void finish(Image& out);

private:
    int width_, height_, oldest_ = 0, pending_ = 0;
    std::array<GlBuffer, depth> buffers_;
};

}  // namespace unravel::render
