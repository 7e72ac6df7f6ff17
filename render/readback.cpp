#include "render/readback.hpp"

#include <cassert>
#include <cstring>

#include "render/gl_context.hpp"

namespace unravel::render {

Readback::Readback(int width, int height) : width_(width), height_(height) {
    for (const GlBuffer& buffer : buffers_)
        allocate_buffer(GL_PIXEL_PACK_BUFFER, buffer, std::size_t{4} * width * height, GL_STREAM_READ);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void Readback::start() {
    assert(pending_ < depth);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers_[(oldest_ + pending_) % depth]);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    // RGBA: drivers convert to RGB on the CPU, several times slower.
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    ++pending_;
}

void Readback::finish(Image& out) {
    assert(pending_ > 0);
    const std::size_t row = std::size_t{4} * width_;
    out.width = width_;
    out.height = height_;
    out.pixels.resize(row * height_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers_[oldest_]);
    const auto* bytes = static_cast<const std::uint8_t*>(
        glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(row * height_), GL_MAP_READ_BIT));
    if (!bytes)
        throw RendererError("glMapBufferRange failed while reading a frame: the renderer is out of memory");
    for (int y = 0; y < height_; ++y)
        std::memcpy(out.pixels.data() + row * y, bytes + row * (height_ - 1 - y), row);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    oldest_ = (oldest_ + 1) % depth;
    --pending_;
}

}  // namespace unravel::render
