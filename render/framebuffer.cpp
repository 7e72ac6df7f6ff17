#include "render/framebuffer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace unravel {

namespace {

void check_complete(const char* what) {
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw RendererError(
            fmt::format("the renderer refuses the {} framebuffer (status 0x{:04x}); try a smaller "
                        "size, fewer samples or --device software",
                        what, status));
}

int clamped_samples(const GlContext& context, int asked) {
    GLint textures = 1;
    glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &textures);
    return std::clamp(asked, 1, std::max(1, std::min(context.max_samples(), static_cast<int>(textures))));
}

}  // namespace

Framebuffer::Framebuffer(const GlContext& context, int width, int height, int samples, int supersample)
    : width_(width),
      height_(height),
      samples_(clamped_samples(context, samples)),
      supersample_(std::max(1, supersample)),
      lay_({"screen.vert"}, {"layer.frag"}, fmt::format("#define SAMPLES {}\n", samples_)),
      average_({"screen.vert"}, {"average.frag"}) {
    const int w = width_ * supersample_, h = height_ * supersample_;
    GLint limit = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
    if (width < 1 || height < 1 || w > limit || h > limit)
        throw RendererError(
            fmt::format("a {}×{} frame with supersampling {} is beyond the renderer's limit of {} pixels "
                        "a side: ask for a smaller size or less supersampling",
                        width, height, supersample_, limit));

    // With one sample the multisample calls would still give a multisampled (slower) target on some drivers.
    const GLenum kind = samples_ > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    glBindTexture(kind, layer_color_);
    if (samples_ > 1)
        glTexImage2DMultisample(kind, samples_, GL_SRGB8_ALPHA8, w, h, GL_TRUE);
    else
        glTexImage2D(kind, 0, GL_SRGB8_ALPHA8, w, h, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    if (samples_ == 1) glTexParameteri(kind, GL_TEXTURE_MAX_LEVEL, 0);
    glBindRenderbuffer(GL_RENDERBUFFER, layer_depth_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_ > 1 ? samples_ : 0, GL_DEPTH_COMPONENT24, w,
                                     h);
    glBindFramebuffer(GL_FRAMEBUFFER, layer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, kind, layer_color_, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, layer_depth_);
    check_complete("multisampled");

    glBindTexture(GL_TEXTURE_2D, backdrop_color_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, w, h, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, backdrop_color_, 0);
    check_complete("backdrop");

    glBindRenderbuffer(GL_RENDERBUFFER, finished_color_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, finished_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, finished_color_);
    check_complete("output");

    lay_.sampler("layer", 0);
    average_.sampler("picture", 0);
    glUniform1i(average_.uniform("factor"), supersample_);
}

void Framebuffer::begin_backdrop() const {
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop_);
    glViewport(0, 0, width_ * supersample_, height_ * supersample_);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
}

void Framebuffer::begin_layer(const PixelRect& rect) const {
    glBindFramebuffer(GL_FRAMEBUFFER, layer_);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);  // all of it: a rectangle would be drawn, not cleared
    glEnable(GL_SCISSOR_TEST);
    glScissor(rect.x, rect.y, rect.width, rect.height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    if (samples_ > 1) glEnable(GL_MULTISAMPLE);
}

void Framebuffer::finish(const PixelRect& rect) const {
    glDisable(GL_MULTISAMPLE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(no_vertices_);
    glActiveTexture(GL_TEXTURE0);
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop_);
    if (!rect.empty()) {
        glBindTexture(samples_ > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D, layer_color_);
        glEnable(GL_SCISSOR_TEST);
        glScissor(rect.x, rect.y, rect.width, rect.height);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        lay_.use();
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glDisable(GL_BLEND);
    }
    glDisable(GL_SCISSOR_TEST);
    if (supersample_ > 1) {
        glBindFramebuffer(GL_FRAMEBUFFER, finished_);
        glViewport(0, 0, width_, height_);
        glBindTexture(GL_TEXTURE_2D, backdrop_color_);
        average_.use();
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, finished_);
    } else {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, backdrop_);
    }
}

}  // namespace unravel
