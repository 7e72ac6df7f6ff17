#pragma once

#include <functional>

#include "render/draw_scene.hpp"
#include "render/frame_block.hpp"
#include "render/gl_objects.hpp"

namespace unravel::render {

/// Depth maps of a frame: one sharp map from the key light, and a sheet of coarse ones from directions spread
/// over the sky, whose mean tells each vertex how open it lies (ambient occlusion from the true geometry).
class ShadowMaps {
public:
    static constexpr float lamp = 0.05f;  ///< tangent of the key light's radius: about six degrees across

    /// `draw(transform, coarse)` draws everything that casts a shadow, world to clip space; coarsely for
    /// small maps.
    using DrawCasters = std::function<void(const Eigen::Matrix4f& transform, bool coarse)>;

    /// Maps cover the sphere around the scene's bounds.
    ShadowMaps(const DrawScene& scene, int key_size);

    /// Fills in the parts of the block that belong to shadows; they never change.
    void describe(FrameBlock& block) const;
    void draw(const DrawCasters& draw_casters) const;
    /// Binds the maps to their texture units.
    void bind() const;
    /// Points a program's samplers at those units.
    static void connect(const GlProgram& program);

private:
    static constexpr int tile = 256, columns = 4, rows = 2;
    static constexpr int unit_key = 1, unit_sky = 2;

    int key_size_;
    float radius_;
    Vec3f key_direction_;
    Eigen::Matrix4f key_transform_;  ///< world to clip space
    std::array<Eigen::Matrix4f, FrameBlock::sky_directions> sky_transforms_;
    std::array<Vec3f, FrameBlock::sky_directions> sky_directions_;
    GlTexture key_map_, sky_maps_;
    GlFramebuffer key_target_, sky_target_;
};

}  // namespace unravel::render
