#pragma once

#include <memory>
#include <span>
#include <string>

#include "render/draw_scene.hpp"
#include "render/gl_context.hpp"
#include "render/image.hpp"

namespace unravel::render {

/// How much a textured picture may cost.
enum class Quality {
    draft,     ///< one sample a pixel, shadows with hard edges, no shade of the sky
    standard,  ///< soft shadows and shade worked out in one go
    final_     ///< the mean of many pictures, each with its own place on lamp, sky, lens and pixel
};

struct RenderSettings {
    int width = 1280, height = 720;  ///< px
    /// Per pixel, clamped to what the renderer offers. 0: four on a GPU; in software one, with outlines
    /// smoothed, which looks the same and costs half.
    int samples = 0;
    int supersample = 1;     ///< each pixel is the mean of supersample² drawn ones
    bool exposures = false;  ///< whether pictures may be the mean of several frames
    Quality quality = Quality::standard;
    int passes = 32;  ///< pictures of a final one; with more exposures than that, as many as those
};

/// Draws the frames of one scene. Lives on the context's thread. Everything is created with it: drawing
/// allocates nothing on the renderer.
class Renderer {
public:
    /// `context` and `scene` must outlive the renderer. Throws RendererError where the size is beyond the
    /// renderer.
    Renderer(const GlContext& context, const DrawScene& scene, RenderSettings settings);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Draws one frame into `out`, whose memory is reused. Throws std::invalid_argument where the frame's
    /// arrays do not fit the scene, or where frames of submit() are under way.
    void draw(DrawStyle style, const DrawFrame& frame, Image& out);

    /// The same in two halves, so that a GPU draws while earlier frames travel: up to three may be under way.
    void submit(DrawStyle style, const DrawFrame& frame) { submit(style, std::span(&frame, 1)); }
    /// One picture as the mean, in linear light, of frames close in time: what moves is blurred.
    void submit(DrawStyle style, std::span<const DrawFrame> exposures);
    void collect(Image& out);  ///< the oldest frame under way
    int pending() const;

    /// One line: renderer, samples asked and given, supersampling.
    std::string description() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace unravel::render
