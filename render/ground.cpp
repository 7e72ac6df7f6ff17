#include "render/ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/bounds.hpp"
#include "render/color.hpp"
#include "render/picture_texture.hpp"

namespace unravel::render {

namespace {

// The component view shows no more ground than tells where it lies.
constexpr float quiet_tone = 2.0f, quiet_begin = 0.105f, quiet_end = 0.295f;  // of the ground's reach

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

Ground::Ground(const DrawScene& scene, const Options& options)
    : scene_(&scene),
      key_(scene.key_direction.normalized()),
      blends_(options.blends),
      sharp_(options.sharp),
      size_(options.map_size),
      open_({"map.vert"}, {"frame.glsl", "light.glsl", "pattern.glsl", "ground_open.frag"}, options.light),
      visible_({"map.vert"}, {"frame.glsl", "light.glsl", "pattern.glsl", "ground_visible.frag"},
               options.light),
      soft_({"map.vert"}, {"ground_soft.frag"}),
      shown_({"frame.glsl", "light.glsl", "ground.vert"},
             {"frame.glsl", "light.glsl", "tone.glsl", "color.glsl", "written.glsl", "ground.frag"},
             fmt::format("#define GRID {}\n#define ENCODED {}\n#define FADES {}\n#define PICTURE {}\n{}",
                         cells, options.encoded ? 1 : 0, blends_ ? 1 : 0,
                         scene.ground_texture.pixels.empty() ? 0 : 1, options.shown)),
      quiet_({"frame.glsl", "ground_quiet.vert"},
             {"frame.glsl", "color.glsl", "written.glsl", "ground_quiet.frag"}, "#define ENCODED 0\n") {
    // Fine enough to hold the shadow of the sphere around the scene.
    const float radius = 0.5f * (scene.bounds_high - scene.bounds_low).norm();
    least_texel_ = 2.2f * radius / std::max(key_.y(), lowest_light) / static_cast<float>(size_);

    make_map(rough_open_map_, rough_open_target_, GL_R16, open_size, open_size);
    make_map(open_map_, open_target_, GL_R16, open_size, open_size);
    make_map(visible_map_, visible_target_, GL_R8, size_, size_);
    make_map(soft_map_, soft_target_, GL_R8, size_, size_);

    for (const GlProgram* program : {&open_, &visible_, &soft_, &shown_, &quiet_}) {
        program->use();
        const Vec3f albedo = program == &quiet_ ? Vec3f(quiet_tone * linear(scene.components_background))
                                                : linear(scene.ground);
        glUniform1f(program->uniform("level"), scene.ground_height);
        glUniform3fv(program->uniform("albedo"), 1, albedo.data());
        ShadowMaps::connect(*program);
        program->sampler("open_map", first_unit);
        program->sampler("visible_map", first_unit);
        program->sampler("soft_map", first_unit + 1);
        program->sampler("picture", 0);
    }
    shown_.use();
    glUniform1f(shown_.uniform("per_picture"), 1 / scene.ground_size);
    if (!scene.ground_texture.pixels.empty()) upload_picture(picture_, scene.ground_texture, true);
    quiet_.use();
    glUniform2f(quiet_.uniform("fade"), quiet_begin, quiet_end);

    // A square: what lies behind the camera is clipped away.
    const float y = scene.ground_height;
    const std::array<Vec3f, 4> corners{Vec3f(-1, y, -1), Vec3f(-1, y, 1), Vec3f(1, y, -1), Vec3f(1, y, 1)};
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

/// Where this frame's shapes may shade the ground, penumbras and all.
Ground::Region Ground::shadow_region(const DrawFrame& frame) const {
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
    const float margin = scene_->light.key_radius * top / (lowness * lowness);
    return {low - margin, (high - low).max(-2 * margin) + 2 * margin};
}

/// Lays the key light's map around `shadow`, by whole texels so that what stands still keeps its place in it,
/// and gives the part of it where the shadow is.
PixelRect Ground::place(const Region& shadow) {
    constexpr float rim = 5;  // texels, for the map's softening
    const float sides = static_cast<float>(size_);
    const float texel = stepped(shadow.extent.maxCoeff() / (sides - 2 * rim - 1), least_texel_);
    const auto snapped = [&](const Eigen::Array2f& at) { return Eigen::Array2f((at / texel).floor()); };
    const Eigen::Array2f first = snapped(shadow.low + 0.5f * shadow.extent) - std::floor(0.5f * sides);
    region_ = {first * texel, Eigen::Array2f::Constant(sides * texel)};
    const Eigen::Array2f from = (snapped(shadow.low) - first - rim).max(0).min(sides);
    const Eigen::Array2f to = (snapped(shadow.low + shadow.extent) - first + rim + 1).max(0).min(sides);
    return {static_cast<int>(from.x()), static_cast<int>(from.y()), static_cast<int>(to.x() - from.x()),
            static_cast<int>(to.y() - from.y())};
}

void Ground::set_regions() const {
    const auto set = [](const GlProgram& program, const char* name, const Region& region) {
        program.use();
        glUniform4f(program.uniform(name), region.low.x(), region.low.y(), region.extent.x(),
                    region.extent.y());
    };
    set(open_, "region", open_region_);
    set(visible_, "region", region_);
    set(shown_, "region", region_);
    set(shown_, "open_region", open_region_);
}

void Ground::soften(GLuint map, GLuint target) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glActiveTexture(GL_TEXTURE0 + first_unit);
    glBindTexture(GL_TEXTURE_2D, map);
    soft_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Ground::light(const DrawFrame& frame, const ShadowMaps& shadows) {
    if (!scene_->show_ground || sharp_) return;
    const Eigen::Array2f middle(shadows.centre().x(), shadows.centre().z());
    open_region_ = {middle - 2 * shadows.radius(), Eigen::Array2f::Constant(4 * shadows.radius())};
    const PixelRect rect = place(shadow_region(frame));
    set_regions();
    shadows.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glBindVertexArray(square_);
    glViewport(0, 0, open_size, open_size);
    glBindFramebuffer(GL_FRAMEBUFFER, rough_open_target_);
    open_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    soften(rough_open_map_, open_target_);

    glViewport(0, 0, size_, size_);
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
    soften(visible_map_, soft_target_);
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
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, picture_);
    shown_.use();
    if (blends_) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    glBindVertexArray(grid_);
    glDrawElements(GL_TRIANGLES, 6 * cells * cells, GL_UNSIGNED_SHORT, nullptr);
    glDisable(GL_BLEND);
}

}  // namespace unravel::render
