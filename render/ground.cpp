#include "render/ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/bounds.hpp"
#include "render/color.hpp"

namespace unravel::render {

namespace {

// The component view shows no more ground than tells where it lies.
constexpr float quiet_tone = 2.0f, quiet_begin = 0.1f, quiet_end = 0.28f;

// A light lower than this casts shadows beyond the map; they fade at its rim.
constexpr float lowest_light = 0.3f;

void make_map(GLuint texture, GLuint framebuffer, GLint format, int width, int height) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

/// Where the ray from p towards the light's far side meets the ground.
Eigen::Array2f shadow_of(const Vec3f& p, const Vec3f& key, float level) {
    const float run = std::max(p.y() - level, 0.f) / std::max(key.y(), lowest_light);
    return {p.x() - run * key.x(), p.z() - run * key.z()};
}

}  // namespace

Ground::Ground(const DrawScene& scene, float reach, int map_size, bool encoded)
    : scene_(&scene),
      key_(scene.key_direction.normalized()),
      centre_(0.5f * (scene.bounds_low + scene.bounds_high)),
      reach_(reach),
      open_({"map.vert"}, {"frame.glsl", "light.glsl", "ground_open.frag"}),
      visible_({"map.vert"}, {"frame.glsl", "light.glsl", "pattern.glsl", "ground_visible.frag"}),
      soft_({"map.vert"}, {"ground_soft.frag"}),
      shown_({"frame.glsl", "light.glsl", "ground.vert"}, {"color.glsl", "written.glsl", "ground.frag"},
             fmt::format("#define GRID {}\n#define ENCODED {}\n", cells, encoded ? 1 : 0)),
      quiet_({"frame.glsl", "ground_quiet.vert"}, {"frame.glsl", "ground_quiet.frag"}) {
    // The map holds the scene's surroundings and the shadow of the sphere around it.
    const float radius = 0.5f * (scene.bounds_high - scene.bounds_low).norm();
    const Eigen::Array2f middle(centre_.x(), centre_.z());
    const Eigen::Array2f shadow = shadow_of(centre_, key_, scene.ground_height);
    const float shadow_radius = radius / std::max(key_.y(), lowest_light);
    low_ = (middle - 1.2f * radius).min(shadow - shadow_radius);
    extent_ = (middle + 1.2f * radius).max(shadow + shadow_radius) - low_;
    const float texel = extent_.maxCoeff() / static_cast<float>(map_size);
    width_ = std::max(1, static_cast<int>(std::lround(extent_.x() / texel)));
    height_ = std::max(1, static_cast<int>(std::lround(extent_.y() / texel)));

    make_map(open_map_, open_target_, GL_R8, open_size, open_size);
    make_map(visible_map_, visible_target_, GL_R8, width_, height_);
    make_map(soft_map_, soft_target_, GL_R8, width_, height_);

    for (const GlProgram* program : {&open_, &visible_, &soft_, &shown_, &quiet_}) {
        program->use();
        const Vec3f albedo = program == &quiet_ ? Vec3f(quiet_tone * linear(scene.components_background))
                                                : linear(scene.ground);
        glUniform1f(program->uniform("level"), scene.ground_height);
        glUniform4f(program->uniform("region"), low_.x(), low_.y(), extent_.x(), extent_.y());
        glUniform3fv(program->uniform("albedo"), 1, albedo.data());
        ShadowMaps::connect(*program);
        program->sampler("open_map", first_unit);
        program->sampler("visible_map", first_unit);
        program->sampler("soft_map", first_unit + 1);
    }
    shown_.use();
    glUniform1f(shown_.uniform("reach"), reach_ * fade_end);
    glUniform2f(shown_.uniform("fade"), reach_ * fade_begin, reach_ * fade_end);
    quiet_.use();
    glUniform1f(quiet_.uniform("extent"), quiet_end);
    glUniform2f(quiet_.uniform("fade"), reach_ * quiet_begin, reach_ * quiet_end);

    // One large square: what lies behind the camera is clipped away.
    const float x = centre_.x(), z = centre_.z(), y = scene.ground_height;
    const std::array<Vec3f, 4> corners{Vec3f(x - reach_, y, z - reach_), Vec3f(x - reach_, y, z + reach_),
                                       Vec3f(x + reach_, y, z - reach_), Vec3f(x + reach_, y, z + reach_)};
    glBindVertexArray(square_);
    fill_buffer(GL_ARRAY_BUFFER, corners_, corners);
    float_attribute(0, 3, sizeof(Vec3f), 0);

    std::vector<std::uint16_t> triangles;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const auto a = static_cast<std::uint16_t>(row * (cells + 1) + column);
            const auto b = static_cast<std::uint16_t>(a + 1), c = static_cast<std::uint16_t>(a + cells + 1),
                       d = static_cast<std::uint16_t>(c + 1);
            triangles.insert(triangles.end(), {a, b, c, c, b, d});
        }
    glBindVertexArray(grid_);
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, cells_, triangles);
    glBindVertexArray(0);
}

PixelRect Ground::shadow_rect(const DrawFrame& frame) const {
    const float level = scene_->ground_height;
    Eigen::Array2f low = Eigen::Array2f::Constant(1e9f), high = -low;
    float top = 0;
    const auto stretch = [&](const Vec3f& p) {
        const Eigen::Array2f at = shadow_of(p, key_, level);
        low = low.min(at);
        high = high.max(at);
        top = std::max(top, p.y() - level);
    };
    visit_bounds(*scene_, frame, std::ref(stretch));
    // Penumbras reach out by half the lamp's width as seen from the ground, stretched where it stands low.
    const float lowness = std::max(key_.y(), lowest_light);
    const float margin = ShadowMaps::lamp * top / (lowness * lowness);
    const Eigen::Array2f size(width_, height_);
    const Eigen::Array2f from = ((low - margin - low_) / extent_ * size - 4).max(0).min(size);
    const Eigen::Array2f to = ((high + margin - low_) / extent_ * size + 5).max(0).min(size);
    return {static_cast<int>(from.x()), static_cast<int>(from.y()), static_cast<int>(to.x() - from.x()),
            static_cast<int>(to.y() - from.y())};
}

void Ground::light(const DrawFrame& frame, const ShadowMaps& shadows) const {
    if (!scene_->show_ground) return;
    shadows.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glBindVertexArray(square_);
    glBindFramebuffer(GL_FRAMEBUFFER, open_target_);
    glViewport(0, 0, open_size, open_size);
    open_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);

    const PixelRect rect = shadow_rect(frame);
    glViewport(0, 0, width_, height_);
    glClearColor(1, 1, 1, 1);
    for (const GLuint target : {GLuint{visible_target_}, GLuint{soft_target_}}) {
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    if (rect.empty()) return;
    glEnable(GL_SCISSOR_TEST);
    glScissor(rect.x, rect.y, rect.width, rect.height);
    glBindFramebuffer(GL_FRAMEBUFFER, visible_target_);
    visible_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindFramebuffer(GL_FRAMEBUFFER, soft_target_);
    glActiveTexture(GL_TEXTURE0 + first_unit);
    glBindTexture(GL_TEXTURE_2D, visible_map_);
    soft_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_SCISSOR_TEST);
}

void Ground::draw(DrawStyle style, const Vec3f& eye) const {
    if (!seen_from(eye)) return;
    if (style == DrawStyle::components) {
        quiet_.use();
        glBindVertexArray(square_);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        return;
    }
    glActiveTexture(GL_TEXTURE0 + first_unit);
    glBindTexture(GL_TEXTURE_2D, open_map_);
    glActiveTexture(GL_TEXTURE0 + first_unit + 1);
    glBindTexture(GL_TEXTURE_2D, soft_map_);
    shown_.use();
    glBindVertexArray(grid_);
    glDrawElements(GL_TRIANGLES, 6 * cells * cells, GL_UNSIGNED_SHORT, nullptr);
}

}  // namespace unravel::render
