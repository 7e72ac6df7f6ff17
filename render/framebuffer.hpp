#pragma once

#include "render/draw_scene.hpp"
#include "render/gl_context.hpp"
#include "render/gl_objects.hpp"

namespace unravel::render {

/// Pixels of a target, from its lower left corner.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
};

/// What frames are drawn into: a picture in sRGB, supersample × as wide and high as they come out, with as
/// many samples a pixel as asked. Several exposures make one frame: their mean is a frame blurred by motion.
/// All means are taken in linear light.
class Framebuffer {
public:
    struct Options {
        int width, height;  ///< of the finished frame [px]
        int samples;        ///< beyond what the renderer offers they are clamped, see samples()
        int supersample;
        bool exposures;    ///< frames may have several
        bool transparent;  ///< frames keep their alpha, and colours are not multiplied by it
        /// Shaders write sRGB, not linear light. A software renderer encodes each pixel in a way of its own
        /// that takes longer than all else about it. What is blended in such a picture is blended as encoded.
        bool encoded;
        bool outlines;  ///< smooth them by begin_outlines(), with one sample a pixel
        /// The picture holds linear light of any brightness; of frames that are the mean of many, tones are
        /// made by develop().
        bool light = false;
    };
    /// Throws RendererError where the renderer cannot hold a picture of this size.
    Framebuffer(const GlContext& context, const Options& options);

    int width() const { return width_; }    ///< of the finished frame [px]
    int height() const { return height_; }  ///< likewise
    int samples() const { return samples_; }
    int supersample() const { return supersample_; }
    bool encoded() const { return encoded_; }
    /// All of the picture.
    PixelRect whole() const { return {0, 0, width_ * supersample_, height_ * supersample_}; }

    /// Makes the picture current, of one colour or, where transparent, of none, and of greatest depth.
    /// Colours are premultiplied by alpha.
    void begin(Rgb background) const;
    /// Whether outlines are to be smoothed, which only pixels of one sample need.
    bool smooths_outlines() const { return smooths_; }
    /// Makes the picture current within `rect` for those pixels to be replaced that outlines run through,
    /// without its depth. What it holds there, and its depth, are on texture units 0 and 1.
    void begin_outlines(const PixelRect& rect) const;
    /// Averages the picture down, as the k-th exposure of n; after the last one the finished frame is bound
    /// for reading.
    void finish(int k = 0, int n = 1) const;
    /// Adds the picture to the mean of light, as the k-th of n.
    void expose(int k, int n) const;
    /// Makes the finished frame current, of one colour or, where transparent, of none: what lies behind is
    /// drawn now.
    void begin_finished(Rgb background) const;
    /// Lays the mean of light over that as a picture, which is bound for reading.
    void develop() const;

private:
    void resolve() const;
    void average(GLuint target, GLuint picture, int factor, float share, bool straight) const;

    int width_, height_, samples_, supersample_;
    bool transparent_, encoded_, smooths_, light_;
    GlFramebuffer picture_, flat_, copy_, resolved_, exposed_, finished_;
    GlRenderbuffer finished_color_;
    GlTexture picture_color_, picture_depth_, copy_color_, resolved_color_, exposed_color_;
    GlVertexArray no_vertices_;
    GlProgram resolve_, average_, develop_;
    GLint factor_, share_, straight_;
};

}  // namespace unravel::render
