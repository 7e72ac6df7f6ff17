#include "render/framebuffer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/color.hpp"

namespace unravel::render {

namespace {

void check_complete(const char* what) {
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw RendererError(
            fmt::format("the renderer refuses the {} framebuffer (status 0x{:04x}); try a smaller "
                        "size, fewer samples or --device software",
                        what, status));
}

/// A texture that is drawn into and then read texel by texel.
void make_target(GLuint texture, GLuint framebuffer, GLenum format, int width, int height, const char* what) {
    allocate_texels(texture, format, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    check_complete(what);
}

/// Storage of one of the picture's textures. With one sample the multisample calls would still give a
/// multisampled (slower) target on some drivers.
void make_samples(GLuint texture, GLenum attachment, int samples, GLenum format, GLenum channels, GLenum type,
                  int width, int height) {
    const GLenum kind = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    if (samples > 1) {
        glBindTexture(kind, texture);
        glTexImage2DMultisample(kind, samples, format, width, height, GL_TRUE);
    } else {
        allocate_texels(texture, format, width, height, channels, type);
    }
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, kind, texture, 0);
}

}  // namespace

Framebuffer::Framebuffer(const GlContext& context, const Options& options)
    : width_(options.width),
      height_(options.height),
      samples_(std::clamp(options.samples, 1, context.max_samples())),
      supersample_(std::max(1, options.supersample)),
      transparent_(options.transparent),
      encoded_(options.encoded),
      smooths_(options.outlines && samples_ == 1),
      light_(options.light),
      resolve_({"screen.vert"}, {"resolve.frag"}, fmt::format("#define SAMPLES {}\n", samples_)),
      average_({"screen.vert"}, {"average.frag"}),
      develop_({"screen.vert"}, {"tone.glsl", "color.glsl", "written.glsl", "develop.frag"},
               "#define ENCODED 0\n"),
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

    glBindFramebuffer(GL_FRAMEBUFFER, picture_);
    make_samples(picture_color_, GL_COLOR_ATTACHMENT0, samples_, light_ ? GL_RGBA16F : GL_SRGB8_ALPHA8,
                 GL_RGBA, GL_UNSIGNED_BYTE, w, h);
    make_samples(picture_depth_, GL_DEPTH_ATTACHMENT, samples_, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT,
                 GL_UNSIGNED_INT, w, h);
    check_complete(samples_ > 1 ? "multisampled" : "picture's");
    if (samples_ > 1) make_target(resolved_color_, resolved_, GL_SRGB8_ALPHA8, w, h, "resolving");
    if (smooths_) {
        glBindFramebuffer(GL_FRAMEBUFFER, flat_);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_color_, 0);
        check_complete("outlines'");
        make_target(copy_color_, copy_, encoded_ ? GL_RGBA8 : GL_SRGB8_ALPHA8, w, h, "outlines'");
    }
    // A sum of many small shares needs more than eight bits.
    if (options.exposures || light_)
        make_target(exposed_color_, exposed_, light_ ? GL_RGBA32F : GL_RGBA16F, width_, height_,
                    "exposure's");

    glBindRenderbuffer(GL_RENDERBUFFER, finished_color_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, finished_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, finished_color_);
    check_complete("output");

    resolve_.sampler("picture", 0);
    average_.sampler("picture", 0);
    develop_.sampler("picture", 0);
}

void Framebuffer::begin(Rgb background) const {
    glBindFramebuffer(GL_FRAMEBUFFER, picture_);
    glViewport(0, 0, width_ * supersample_, height_ * supersample_);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    if (samples_ > 1) glEnable(GL_MULTISAMPLE);
    // Without it the target takes colours as they are.
    (encoded_ ? glDisable : glEnable)(GL_FRAMEBUFFER_SRGB);
    const Vec3f bytes(background.r, background.g, background.b);
    const bool clear = transparent_ || light_;
    const Vec3f c = clear ? Vec3f(0, 0, 0) : encoded_ ? Vec3f(bytes / 255) : linear(background);
    glClearColor(c.x(), c.y(), c.z(), clear ? 0 : 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Framebuffer::begin_outlines(const PixelRect& rect) const {
    const int right = rect.x + rect.width, top = rect.y + rect.height;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, picture_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, copy_);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glBlitFramebuffer(rect.x, rect.y, right, top, rect.x, rect.y, right, top, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, flat_);
    if (!encoded_) glEnable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DEPTH_TEST);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, picture_depth_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, copy_color_);
}

/// The mean of each pixel's samples.
void Framebuffer::resolve() const {
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glViewport(0, 0, width_ * supersample_, height_ * supersample_);
    glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, picture_color_);
    resolve_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
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

void Framebuffer::finish(int k, int n) const {
    glDisable(GL_MULTISAMPLE);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glBindVertexArray(no_vertices_);
    glActiveTexture(GL_TEXTURE0);
    if (samples_ > 1) resolve();
    const GLuint picture = samples_ > 1 ? resolved_color_ : picture_color_;
    if (n > 1) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, k == 0 ? GL_ZERO : GL_ONE);
        average(exposed_, picture, supersample_, 1.f / static_cast<float>(n), false);
        glDisable(GL_BLEND);
        if (k + 1 < n) return;
        average(finished_, exposed_color_, 1, 1, transparent_);
    } else if (supersample_ > 1 || transparent_) {
        average(finished_, picture, supersample_, 1, transparent_);
    } else {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_ > 1 ? resolved_ : picture_);
        return;
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, finished_);
}

void Framebuffer::expose(int k, int n) const {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(no_vertices_);
    glActiveTexture(GL_TEXTURE0);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, k == 0 ? GL_ZERO : GL_ONE);
    average(exposed_, picture_color_, supersample_, 1.f / static_cast<float>(n), false);
    glDisable(GL_BLEND);
}

void Framebuffer::begin_finished(Rgb background) const {
    glBindFramebuffer(GL_FRAMEBUFFER, finished_);
    glViewport(0, 0, width_, height_);
    glDisable(GL_BLEND);
    glEnable(GL_FRAMEBUFFER_SRGB);
    const Vec3f c = transparent_ ? Vec3f(0, 0, 0) : linear(background);
    glClearColor(c.x(), c.y(), c.z(), transparent_ ? 0 : 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

void Framebuffer::develop() const {
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_vertices_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, exposed_color_);
    develop_.use();
    glUniform1i(develop_.uniform("straight"), transparent_ ? 1 : 0);
    if (!transparent_) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, finished_);
}

}  // namespace unravel::render
