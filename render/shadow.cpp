#include "render/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/camera.hpp"

namespace unravel::render {

namespace {

/// Parallel projection from `direction` that maps the sphere (centre, radius) to clip space, `texels` along a
/// side that lie where they lie for any other centre.
Eigen::Matrix4f parallel(const Vec3f& centre, float radius, const Vec3f& direction, int texels) {
    const Eigen::Matrix4f turn = look_at(direction, Vec3f::Zero(), Vec3f(0, 1, 0));
    const float texel = 2 * radius / static_cast<float>(texels);
    Vec3f middle = turn.topLeftCorner<3, 3>() * centre;
    middle = (middle / texel).array().round() * texel;
    Eigen::Matrix4f squeeze = Eigen::Matrix4f::Identity();
    squeeze(0, 0) = squeeze(1, 1) = 1 / radius;
    squeeze(2, 2) = -1 / radius;  // what is nearest to the light has depth −1
    squeeze.col(3).head<3>() = -squeeze.diagonal().head<3>().cwiseProduct(middle);
    Eigen::Matrix4f rotation = Eigen::Matrix4f::Identity();
    rotation.topLeftCorner<3, 3>() = turn.topLeftCorner<3, 3>();
    return squeeze * rotation;
}

/// Clip space to a tile of a texture: x, y, z in [0, 1] scaled and moved.
Eigen::Matrix4f to_texture(float scale_x, float scale_y, float x, float y) {
    Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
    m.diagonal() << 0.5f * scale_x, 0.5f * scale_y, 0.5f, 1;
    m.col(3) << 0.5f * scale_x + x, 0.5f * scale_y + y, 0.5f, 1;
    return m;
}

void make_depth_map(GLuint texture, GLuint framebuffer, int width, int height) {
    allocate_texels(texture, GL_DEPTH_COMPONENT24, width, height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
}

}  // namespace

float stepped(float size, float least) {
    const float steps = std::ceil(4 * std::log2(std::max(size, 1e-3f) / least) - 1e-3f);
    return least * std::exp2(0.25f * steps);
}

ShadowMaps::ShadowMaps(const DrawScene& scene, int key_size, Quality quality)
    : sampled_(quality == Quality::final_),
      no_sky_(quality == Quality::draft),
      key_size_(key_size),
      tile_(sampled_ ? key_size : small_tile),
      lamp_(scene.light.key_radius),
      lamp_middle_(scene.key_direction.normalized()),
      key_direction_(lamp_middle_) {
    for (int k = 0; k < FrameBlock::sky_directions; ++k) {
        // Two rings, the upper one turned by half a step: together they spread evenly over the half sphere.
        const float height = k < 4 ? 0.85f : 0.32f, across = std::sqrt(1 - height * height);
        const float angle = std::numbers::pi_v<float> / 4 * (2 * (k % 4) + (k < 4 ? 0.4f : 1.4f));
        sky_directions_[k] = {across * std::cos(angle), height, across * std::sin(angle)};
    }
    make_depth_map(key_map_, key_target_, key_size_, key_size_);
    make_depth_map(sky_maps_, sky_target_, sampled_ ? tile_ : columns * tile_,
                   sampled_ ? tile_ : rows * tile_);
    aim(scene.bounds_low, scene.bounds_high);
}

void ShadowMaps::aim(const Vec3f& low, const Vec3f& high) {
    centre_ = 0.5f * (low + high);
    // A little more than the sphere: its centre moves by up to half a texel.
    radius_ = stepped(0.51f * (high - low).norm(), 1);
    key_transform_ = parallel(centre_, radius_, key_direction_, key_size_);
    for (int k = 0; k < FrameBlock::sky_directions; ++k)
        sky_transforms_[k] = parallel(centre_, radius_, sky_directions_[k], tile_);
}

void ShadowMaps::aim(const Vec3f& low, const Vec3f& high, const Vec2f& on_lamp, const Vec3f& sky) {
    const Eigen::Matrix4f turn = look_at(lamp_middle_, Vec3f::Zero(), Vec3f(0, 1, 0));
    key_direction_ = (lamp_middle_ + turn.block<2, 3>(0, 0).transpose() * (lamp_ * on_lamp)).normalized();
    sky_directions_[0] = sky;
    aim(low, high);
}

void ShadowMaps::describe(FrameBlock& block) const {
    block.shadow_matrix = to_texture(1, 1, 0, 0) * key_transform_;
    const float width = sampled_ ? 1 : 1.f / columns, height = sampled_ ? 1 : 1.f / rows;
    for (int k = 0; k < FrameBlock::sky_directions; ++k) {
        block.sky_matrix[k] =
            to_texture(width, height, (k % columns) * width, (k / columns) * height) * sky_transforms_[k];
        block.sky_direction[k] << sky_directions_[k], 0;
    }
    block.key_direction << key_direction_, lamp_;
    block.shadow << 2 * radius_ / key_size_, 2 * radius_, 2 * radius_ / tile_, 0;
}

void ShadowMaps::draw(const DrawCasters& draw_casters) const {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    // Depths stay as they are: an offset by slope would put what stands edge-on to the light behind
    // everything.
    glDisable(GL_CULL_FACE);   // a cloth has no inside
    glEnable(GL_DEPTH_CLAMP);  // what has moved out of the scene's bounds casts all the same
    glBindFramebuffer(GL_FRAMEBUFFER, key_target_);
    glViewport(0, 0, key_size_, key_size_);
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_casters(key_transform_, false);

    if (!no_sky_) draw_sky(draw_casters);
    glDisable(GL_DEPTH_CLAMP);
}

void ShadowMaps::draw_sky(const DrawCasters& draw_casters) const {
    glBindFramebuffer(GL_FRAMEBUFFER, sky_target_);
    if (sampled_) {
        glViewport(0, 0, tile_, tile_);
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_casters(sky_transforms_[0], false);
        return;
    }
    glViewport(0, 0, columns * tile_, rows * tile_);
    glClear(GL_DEPTH_BUFFER_BIT);
    for (int k = 0; k < FrameBlock::sky_directions; ++k) {
        glViewport((k % columns) * tile_, (k / columns) * tile_, tile_, tile_);
        draw_casters(sky_transforms_[k], true);
    }
}

void ShadowMaps::bind() const {
    const auto bind_unit = [](int unit, GLuint texture) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture);
    };
    bind_unit(unit_key, key_map_);
    bind_unit(unit_sky, sky_maps_);
}

void ShadowMaps::connect(const GlProgram& program) {
    program.sampler("shadow_depth", unit_key);
    program.sampler("sky_depth", unit_sky);
}

}  // namespace unravel::render
