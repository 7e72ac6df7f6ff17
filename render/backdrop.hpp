#pragma once

#include "render/draw_scene.hpp"
#include "render/gl_objects.hpp"

namespace unravel::render {

/// What lies behind everything where that is more than one colour: a gradient, a picture, or the sky.
class Backdrop {
public:
    /// `encoded`: shaders write sRGB.
    Backdrop(const DrawScene& scene, bool encoded);

    /// One colour: nothing is to be drawn.
    bool plain() const { return kind_ == Kind::plain; }
    /// Fills the bound target of this size [px], as `camera` sees it.
    void draw(const CameraView& camera, int width, int height) const;

private:
    enum class Kind { plain, gradient, picture, sky };
    static Kind kind_of(const DrawScene& scene);

    const DrawScene* scene_;
    Kind kind_;
    GlProgram program_;
    GlTexture picture_;
    GlVertexArray no_vertices_;
};

}  // namespace unravel::render
