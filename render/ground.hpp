#pragma once

#include "render/draw_scene.hpp"
#include "render/framebuffer.hpp"
#include "render/gl_objects.hpp"
#include "render/shadow.hpp"

namespace unravel::render {

/// The ground below a scene, fading into the background with distance. It fills most of the picture and has
/// no detail of its own, so what light reaches it is found once a frame, in maps that lie on it and are
/// looked up from the picture.
class Ground {
public:
    /// `reach`: how far it goes from the scene's centre [m]; `map_size`: texels along the map's longer side.
    /// `encoded`: shaders write sRGB.
    Ground(const DrawScene& scene, float reach, int map_size, bool encoded);

    /// Lights the map by this frame's shadow maps, which are to be bound.
    void light(const DrawFrame& frame, const ShadowMaps& shadows) const;
    /// Draws it: lit, or as a faint patch for the component view.
    void draw(DrawStyle style, const Vec3f& eye) const;

private:
    static constexpr int open_size = 48;  ///< openness to the sky varies slowly
    static constexpr int cells = 24;      ///< cells along a side of the ground as it is lit
    static constexpr int first_unit = 3;  ///< texture units before are the shadow maps'
    static constexpr float fade_begin = 0.2f, fade_end = 0.95f;  ///< of its reach

    bool seen_from(const Vec3f& eye) const { return scene_->show_ground && eye.y() > scene_->ground_height; }
    PixelRect shadow_rect(const DrawFrame& frame) const;

    const DrawScene* scene_;
    Vec3f key_, centre_;
    float reach_;
    Eigen::Array2f low_, extent_;  ///< x and z of the map's corner, and its size [m]
    int width_, height_;           ///< of the map [px]
    PixelRect shade_;              ///< of the map: outside it nothing casts a shadow
    GlProgram open_, visible_, soft_, shown_, quiet_;
    GlTexture open_map_, visible_map_, soft_map_;
    GlFramebuffer open_target_, visible_target_, soft_target_;
    GlVertexArray square_, grid_;
    GlBuffer corners_, cells_;
};

}  // namespace unravel::render
