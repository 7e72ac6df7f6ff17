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

/// A texture that is drawn into and then read texel by texel.
void make_target(GLuint texture, GLuint framebuffer, GLenum format, int width, int height, const char* what) {
    allocate_texels(texture, format, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    check_complete(what);
}

/// Storage of one of the layer's textures. With one sample the multisample calls would still give a
/// multisampled (slower) target on some drivers.
void make_samples(GLuint texture, GLenum attachment, int samples, GLenum format, GLenum channels, GLenum type,
                  int width, int height) {
    const GLenum kind = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    glBindTexture(kind, texture);
    if (samples > 1) {
        glTexImage2DMultisample(kind, samples, format, width, height, GL_TRUE);
    } else {
        glTexImage2D(kind, 0, static_cast<GLint>(format), width, height, 0, channels, type, nullptr);
        glTexParameteri(kind, GL_TEXTURE_MAX_LEVEL, 0);
    }
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, kind, texture, 0);
}

}  // namespace

Framebuffer::Framebuffer(const GlContext& context, const Options& options)
    : width_(options.width),
      height_(options.height),
      samples_(clamped_samples(context, options.samples)),
      supersample_(std::max(1, options.supersample)),
      transparent_(options.transparent),
      roots_(options.roots),
      smooths_(options.outlines && samples_ == 1),
      lay_({"screen.vert"}, {"layer.frag"},
           fmt::format("#define SAMPLES {}\n#define ROOTS {}\n", samples_, options.roots ? 1 : 0)),
      average_({"screen.vert"}, {"average.frag"}),
      corner_(lay_.uniform("corner")),
      factor_(average_.uniform("factor")),
      share_(average_.uniform("share")),
      straight_(average_.uniform("straight")) {
    const int w = width_ * supersample_, h = height_ * supersample_;
    GLint limit = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
    if (width_ < 1 || height_ < 1 || w > limit || h > limit)
        throw RendererError(
            fmt::format("a {}×{} frame with supersampling {} is beyond the renderer's limit of {} pixels "
                        "a side: ask for a smaller size or less supersampling",
                        width_, height_, supersample_, limit));

    // Cleared memory is cheap on a GPU, and there the layer never changes.
    if (context.software())
        size_layer(std::min(w, 64), std::min(h, 64));
    else
        size_layer(w, h);
    make_target(backdrop_color_, backdrop_, GL_SRGB8_ALPHA8, w, h, "backdrop");
    // A sum of many small shares needs more than eight bits.
    if (options.exposures) make_target(exposed_color_, exposed_, GL_RGBA16F, width_, height_, "exposure");

    glBindRenderbuffer(GL_RENDERBUFFER, finished_color_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, finished_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, finished_color_);
    check_complete("output");

    lay_.sampler("layer", 0);
    average_.sampler("picture", 0);
}

void Framebuffer::begin_backdrop() const {
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop_);
    glViewport(0, 0, width_ * supersample_, height_ * supersample_);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
}

void Framebuffer::size_layer(int width, int height) {
    layer_width_ = width;
    layer_height_ = height;
    glBindFramebuffer(GL_FRAMEBUFFER, layer_);
    make_samples(layer_color_, GL_COLOR_ATTACHMENT0, samples_, roots_ ? GL_RGBA8 : GL_SRGB8_ALPHA8, GL_RGBA,
                 GL_UNSIGNED_BYTE, width, height);
    make_samples(layer_depth_, GL_DEPTH_ATTACHMENT, samples_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT,
                 GL_UNSIGNED_INT, width, height);
    check_complete("multisampled");
    if (smooths_)
        make_target(smooth_color_, smooth_, roots_ ? GL_RGBA8 : GL_SRGB8_ALPHA8, width, height, "outlines");
}

void Framebuffer::begin_layer(const PixelRect& rect) {
    // Patterns of pixels repeat every four.
    rect_ = {rect.x & ~3, rect.y & ~3, rect.width + (rect.x & 3), rect.height + (rect.y & 3)};
    if (rect_.width > layer_width_ || rect_.height > layer_height_) {
        // Room to move, in whole tiles of llvmpipe.
        const auto roomy = [](int size, int now, int limit) {
            return std::max(now, std::min((size + size / 8 + 63) & ~63, limit));
        };
        size_layer(roomy(rect_.width, layer_width_, whole().width),
                   roomy(rect_.height, layer_height_, whole().height));
    }
    glBindFramebuffer(GL_FRAMEBUFFER, layer_);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);  // all of it: a rectangle would be drawn, not cleared
    glViewport(-rect_.x, -rect_.y, width_ * supersample_, height_ * supersample_);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, rect_.width, rect_.height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    if (samples_ > 1) glEnable(GL_MULTISAMPLE);
}

void Framebuffer::begin_outlines() const {
    const int w = rect_.width, h = rect_.height;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, layer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, smooth_);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, smooth_);
    glDisable(GL_DEPTH_TEST);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, layer_depth_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, layer_color_);
}

void Framebuffer::lay_over(const PixelRect& rect) const {
    if (rect.empty()) return;
    glBindTexture(samples_ > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D,
                  smooths_ ? GLuint{smooth_color_} : GLuint{layer_color_});
    glViewport(0, 0, width_ * supersample_, height_ * supersample_);
    glEnable(GL_SCISSOR_TEST);
    glScissor(rect.x, rect.y, rect.width, rect.height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    lay_.use();
    glUniform2i(corner_, rect_.x, rect_.y);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

void Framebuffer::average(GLuint target, GLuint picture, int factor, float share, bool straight) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glViewport(0, 0, width_, height_);
    glBindTexture(GL_TEXTURE_2D, picture);
    average_.use();
    glUniform1i(factor_, factor);
    glUniform1f(share_, share);
    glUniform1i(straight_, straight ? 1 : 0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Framebuffer::finish(const PixelRect& rect, int k, int n) const {
    glDisable(GL_MULTISAMPLE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(no_vertices_);
    glActiveTexture(GL_TEXTURE0);
    glBindFramebuffer(GL_FRAMEBUFFER, backdrop_);
    lay_over(rect);
    if (n > 1) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, k == 0 ? GL_ZERO : GL_ONE);
        average(exposed_, backdrop_color_, supersample_, 1.f / static_cast<float>(n), false);
        glDisable(GL_BLEND);
        if (k + 1 < n) return;
        average(finished_, exposed_color_, 1, 1, transparent_);
    } else if (supersample_ > 1 || transparent_) {
        average(finished_, backdrop_color_, supersample_, 1, transparent_);
    } else {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, backdrop_);
        return;
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, finished_);
}

}  // namespace unravel
