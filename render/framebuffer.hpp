#pragma once

#include "render/gl_context.hpp"
#include "render/gl_objects.hpp"

namespace unravel {

/// What frames are drawn into: a multisampled sRGB target of supersample × the frame's size, resolved and
/// averaged down to the frame's size. Averages are taken in linear light.
class Framebuffer {
public:
    /// `samples` beyond what the renderer offers are clamped, see samples(). Throws RendererError where the
    /// renderer cannot hold a picture of this size.
    Framebuffer(const GlContext& context, int width, int height, int samples, int supersample);

    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }
    int supersample() const { return supersample_; }

    /// Makes the target current, with sRGB encoding on.
    void bind() const;
    /// Resolves; afterwards the finished frame is bound for reading.
    void resolve() const;

private:
    int width_, height_, samples_, supersample_;
    GlFramebuffer target_, resolved_, finished_;
    GlRenderbuffer target_color_, target_depth_, finished_color_;
    GlTexture resolved_color_;
    GlVertexArray no_vertices_;
    GlProgram average_;
};

}  // namespace unravel
