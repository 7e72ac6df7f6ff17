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
    struct Options {
        int map_size;              ///< texels along a side of its map
        bool encoded;              ///< shaders write sRGB
        bool blends;               ///< what is behind it is more than one colour
        bool sharp;                ///< light is looked up where it is seen, not in maps
        std::string light, shown;  ///< of light_defines.hpp: for its maps, and for the picture
    };
    Ground(const DrawScene& scene, const Options& options);

    /// Lights the maps, laid where this frame's shapes are, by its shadow maps.
    void light(const DrawFrame& frame, const ShadowMaps& shadows);
    /// Draws it: lit, or as a faint patch for the component view.
    void draw(DrawStyle style, const Vec3f& eye) const;

private:
    static constexpr int open_size = 80;  ///< openness to the sky varies slowly
    static constexpr int cells = 24;      ///< cells along a side of the ground as it is lit
    static constexpr int first_unit = 3;  ///< texture units before are the shadow maps'

    /// Part of the ground that a map lies on: x and z of its corner, and its sides [m].
    struct Region {
        Eigen::Array2f low, extent;
    };
    bool seen_from(const Vec3f& eye) const { return scene_->show_ground && eye.y() > scene_->ground_height; }
    Region shadow_region(const DrawFrame& frame) const;
    PixelRect place(const Region& shadow);
    void set_regions() const;
    void soften(GLuint map, GLuint target) const;

    const DrawScene* scene_;
    Vec3f key_;
    bool blends_, sharp_;
    int size_;                     ///< of the key light's maps [px]
    float least_texel_ = 0;        ///< of those maps [m]; larger by steps where shadows are wide
    Region open_region_, region_;  ///< of this frame
    GlProgram open_, visible_, soft_, shown_, quiet_;
    GlTexture picture_;
    GlTexture rough_open_map_, open_map_, visible_map_, soft_map_;
    GlFramebuffer rough_open_target_, open_target_, visible_target_, soft_target_;
    GlVertexArray square_, grid_;
    GlBuffer corners_, cells_;
};

}  // namespace unravel::render
