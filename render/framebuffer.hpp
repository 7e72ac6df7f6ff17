#pragma once

#include "render/gl_context.hpp"
#include "render/gl_objects.hpp"

namespace unravel {

/// Pixels of a target, from its lower left corner.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
};

/// What frames are drawn into, supersample × as wide and high as they come out. Two targets in sRGB:
/// - the backdrop, one sample a pixel, for what fills the picture and has no edges;
/// - the layer, multisampled, for shapes: it starts out transparent, and is laid over the backdrop only
///   where something was drawn.
/// A software renderer pays for every sample of every pixel, drawn or only cleared, so there the layer is no
/// larger than the rectangle it has needed so far: it grows in the first frames of a clip.
/// Several exposures make one picture: their mean is a frame blurred by motion.
/// All means are taken in linear light.
class Framebuffer {
public:
    struct Options {
        int width, height;  ///< of the finished frame [px]
        int samples;        ///< beyond what the renderer offers they are clamped, see samples()
        int supersample;
        bool exposures;    ///< frames may have several
        bool transparent;  ///< frames keep their alpha, and colours are not multiplied by it
        /// Shaders write the square roots of linear colours to the layer. A software renderer converts each
        /// sample to sRGB by itself, which takes longer than all else about a sample; one root for a pixel
        /// costs nothing, and eight bits of it are as fine. What is blended within such a layer is blended in
        /// roots.
        bool roots;
        bool outlines;  ///< smooth them by begin_outlines(), with one sample a pixel
    };
    /// Throws RendererError where the renderer cannot hold a picture of this size.
    Framebuffer(const GlContext& context, const Options& options);

    int width() const { return width_; }    ///< of the finished frame [px]
    int height() const { return height_; }  ///< likewise
    int samples() const { return samples_; }
    int supersample() const { return supersample_; }
    /// All of either target.
    PixelRect whole() const { return {0, 0, width_ * supersample_, height_ * supersample_}; }

    /// Makes the backdrop current: colour only.
    void begin_backdrop() const;
    /// Makes the layer current, transparent and of greatest depth within `rect`, and confines drawing to it.
    /// Colours are premultiplied by alpha.
    void begin_layer(const PixelRect& rect);
    /// Whether outlines are to be smoothed, which only a layer of one sample needs.
    bool smooths_outlines() const { return smooths_; }
    /// Makes a copy of the layer current, for those pixels to be replaced that outlines run through, and puts
    /// the layer and its depth on texture units 0 and 1. The copy is what finish() then takes.
    void begin_outlines() const;
    /// Of the layer within the picture [px].
    PixelRect layer_rect() const { return rect_; }
    /// Lays `rect` of the layer over the backdrop and averages down, as the k-th exposure of n; after the
    /// last one the finished frame is bound for reading.
    void finish(const PixelRect& rect, int k = 0, int n = 1) const;

private:
    void size_layer(int width, int height);
    void lay_over(const PixelRect& rect) const;
    void average(GLuint target, GLuint picture, int factor, float share, bool straight) const;

    int width_, height_, samples_, supersample_;
    bool transparent_, roots_, smooths_;
    int layer_width_ = 0, layer_height_ = 0;
    PixelRect rect_;  ///< of the picture that the layer holds, from its lower left corner on
    GlFramebuffer layer_, smooth_, backdrop_, exposed_, finished_;
    GlRenderbuffer finished_color_;
    GlTexture layer_color_, layer_depth_, smooth_color_, backdrop_color_, exposed_color_;
    GlVertexArray no_vertices_;
    GlProgram lay_, average_;
    GLint corner_, factor_, share_, straight_;
};

}  // namespace unravel
