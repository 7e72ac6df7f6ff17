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

}  // namespace

Framebuffer::Framebuffer(const GlContext& context, int width, int height, int samples, int supersample)
    : width_(width),
      height_(height),
      samples_(std::clamp(samples, 1, std::max(1, context.max_samples()))),
      supersample_(std::max(1, supersample)),
      average_({"screen.vert"}, {"average.frag"}) {
    const int w = width_ * supersample_, h = height_ * supersample_;
    GLint limit = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
    if (width < 1 || height < 1 || w > limit || h > limit)
        throw RendererError(
            fmt::format("a {}×{} frame with supersampling {} is beyond the renderer's limit of {} pixels "
                        "a side: ask for a smaller size or less supersampling",
                        width, height, supersample_, limit));

    // With one sample the multisample calls would still give a multisampled (slower) buffer on some drivers.
    const int storage_samples = samples_ > 1 ? samples_ : 0;
    glBindRenderbuffer(GL_RENDERBUFFER, target_color_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, storage_samples, GL_SRGB8_ALPHA8, w, h);
    glBindRenderbuffer(GL_RENDERBUFFER, target_depth_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, storage_samples, GL_DEPTH_COMPONENT24, w, h);
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target_color_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target_depth_);
    check_complete("multisampled");

    glBindTexture(GL_TEXTURE_2D, resolved_color_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, w, h, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, resolved_color_, 0);
    check_complete("resolve");

    glBindRenderbuffer(GL_RENDERBUFFER, finished_color_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, finished_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, finished_color_);
    check_complete("output");

    average_.sampler("picture", 0);
    glUniform1i(average_.uniform("factor"), supersample_);
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, width_ * supersample_, height_ * supersample_);
    glEnable(GL_FRAMEBUFFER_SRGB);
    if (samples_ > 1)
        glEnable(GL_MULTISAMPLE);
    else
        glDisable(GL_MULTISAMPLE);
}

void Framebuffer::resolve() const {
    const int w = width_ * supersample_, h = height_ * supersample_;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
    if (supersample_ == 1) {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, finished_);
        glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    } else {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
        glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, finished_);
        glViewport(0, 0, width_, height_);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, resolved_color_);
        glBindVertexArray(no_vertices_);
        average_.use();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, finished_);
}

}  // namespace unravel
