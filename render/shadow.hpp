#pragma once

#include <functional>

#include "render/draw_scene.hpp"
#include "render/frame_block.hpp"
#include "render/gl_objects.hpp"
#include "render/renderer.hpp"

namespace unravel::render {

/// Depth maps of a frame: one sharp map from the key light, and a sheet of coarse ones from directions spread
/// over the sky, whose mean tells each vertex how open it lies (ambient occlusion from the true geometry).
/// Pictures of which many make a final one have a map from one direction of the sky each.
class ShadowMaps {
public:
    /// `draw(transform, coarse)` draws everything that casts a shadow, world to clip space; coarsely for
    /// small maps.
    using DrawCasters = std::function<void(const Eigen::Matrix4f& transform, bool coarse)>;

    ShadowMaps(const DrawScene& scene, int key_size, Quality quality);

    /// Aims the maps at the sphere around a frame's box of casters [m], wherever in the clip they have come
    /// to. Its radius grows in steps and its centre by whole texels: shadows of what stands still do not
    /// crawl.
    void aim(const Vec3f& low, const Vec3f& high);
    /// The same for a place on the lamp, in its unit disk, and one direction of the sky.
    void aim(const Vec3f& low, const Vec3f& high, const Vec2f& on_lamp, const Vec3f& sky);
    /// Fills in the parts of the block that belong to shadows as they are aimed.
    void describe(FrameBlock& block) const;
    void draw(const DrawCasters& draw_casters) const;
    /// Binds the maps to their texture units.
    void bind() const;
    /// Points a program's samplers at those units.
    static void connect(const GlProgram& program);

    const Vec3f& centre() const { return centre_; }  ///< of what the maps hold [m]
    float radius() const { return radius_; }         ///< likewise [m]

private:
    void draw_sky(const DrawCasters& draw_casters) const;

    static constexpr int columns = 4, rows = 2, small_tile = 256;
    static constexpr int unit_key = 1, unit_sky = 2;

    bool sampled_, no_sky_;  // one direction of the sky at a time; none at all
    int key_size_, tile_;
    float lamp_;  // tangent of its radius
    float radius_ = 1;
    Vec3f lamp_middle_, key_direction_, centre_{0, 0, 0};
    Eigen::Matrix4f key_transform_;  ///< world to clip space
    std::array<Eigen::Matrix4f, FrameBlock::sky_directions> sky_transforms_;
    std::array<Vec3f, FrameBlock::sky_directions> sky_directions_;
    GlTexture key_map_, sky_maps_;
    GlFramebuffer key_target_, sky_target_;
};

/// `least` times the smallest power of 2^¼ that brings it to `size`: sizes that follow a scene in steps.
float stepped(float size, float least);

}  // namespace unravel::render
