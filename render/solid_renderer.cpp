#include "render/solid_renderer.hpp"

#include <fmt/format.h>

#include "render/color.hpp"
#include "render/picture_texture.hpp"
#include "render/shadow.hpp"

namespace unravel::render {

namespace {

// The component view shows no more ground than tells where it lies.
constexpr float quiet_ground = 0.3f;

}  // namespace

SolidRenderer::Shaded::Shaded(const Variant& of, bool encoded, const std::string& light)
    : variant(of),
      program(
          {"frame.glsl", "light.glsl", "sky.glsl", "yield.glsl", "solid.vert"},
          {"frame.glsl", "quads.glsl", "light.glsl", "tone.glsl", "color.glsl", "written.glsl", "solid.frag"},
          fmt::format("#define FADES {}\n#define POLISHED {}\n#define PICTURE {}\n#define ENCODED {}\n{}",
                      of.fades ? 1 : 0, of.polished ? 1 : 0, of.pictured ? 1 : 0, encoded ? 1 : 0, light)),
      model(program.uniform("model")),
      albedo(program.uniform("albedo")),
      gloss(program.uniform("gloss")),
      fade_centre(program.uniform("fade_centre")),
      metal(program.uniform("metal")),
      per_picture(program.uniform("per_picture")) {
    ShadowMaps::connect(program);
    program.sampler("picture", 0);
}

std::size_t SolidRenderer::program_of(const Variant& variant, bool encoded, const std::string& light) {
    const auto found =
        static_cast<std::size_t>(std::ranges::find(shaded_, variant, &Shaded::variant) - shaded_.begin());
    if (found == shaded_.size()) shaded_.emplace_back(variant, encoded, light);
    return found;
}

SolidRenderer::SolidRenderer(const DrawScene& scene, bool encoded, const std::string& light)
    : scene_(&scene),
      centre_(0.5f * (scene.bounds_low + scene.bounds_high)),
      reach_(2.5f * (scene.bounds_high - scene.bounds_low).norm()),
      reach_now_(reach_) {
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        const SolidMesh& solid = scene.solids[i];
        if (solid.plane) continue;
        const int index = static_cast<int>(i);
        if (!solid.is_mesh()) {
            parts_.push_back({Mesh(solid.fine), Mesh(solid.coarse), index, false, linear(solid.color)});
            continue;
        }
        CreasedMesh creased = crease(solid.triangles, solid.positions);
        const Tessellation shape = tessellate_mesh(creased, solid.positions);
        parts_.push_back({Mesh(shape), Mesh(shape), index, false, linear(solid.color)});
        if (solid.deforms) parts_.back().creased = std::move(creased);
    }
    for (std::size_t i = 0; i < scene.solids.size(); ++i)
        if (scene.solids[i].plane)
            parts_.push_back({Mesh(tessellate_ground(reach_)), Mesh({}), static_cast<int>(i), true,
                              linear(scene.solids[i].color)});
    for (Part& part : parts_) {
        const SolidMesh& solid = scene.solids[static_cast<std::size_t>(part.solid)];
        const bool polished = solid.finish == SurfaceFinish::gloss || solid.finish == SurfaceFinish::metal;
        const bool pictured = !solid.texture.pixels.empty();
        part.program = program_of({part.fades, polished, pictured}, encoded, light);
        if (pictured) upload_picture(part.texture, solid.texture, true);
    }
}

namespace {

std::vector<Vec3f> interleave(const Tessellation& shape) {
    std::vector<Vec3f> out;
    out.reserve(2 * shape.positions.size());
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        out.push_back(shape.positions[i]);
        out.push_back(shape.normals[i]);
    }
    return out;
}

}  // namespace

void SolidRenderer::update_shapes(const DrawFrame& frame) {
    for (Part& part : parts_) {
        const SolidMesh& solid = scene_->solids[static_cast<std::size_t>(part.solid)];
        if (!solid.deforms) continue;
        const Tessellation shape =
            tessellate_mesh(part.creased, frame.solid_positions[static_cast<std::size_t>(part.solid)]);
        part.fine.update(shape);
        part.coarse.update(shape);
    }
}

void SolidRenderer::Mesh::update(const Tessellation& shape) {
    const std::vector<Vec3f> interleaved = interleave(shape);
    update_buffer(GL_ARRAY_BUFFER, vertices, std::span(interleaved));
}

SolidRenderer::Mesh::Mesh(const Tessellation& shape) : count(static_cast<GLsizei>(shape.indices.size())) {
    const std::vector<Vec3f> interleaved = interleave(shape);
    glBindVertexArray(vertex_array);
    fill_buffer(GL_ARRAY_BUFFER, vertices, interleaved);
    float_attribute(0, 3, 2 * sizeof(Vec3f), 0);
    float_attribute(1, 3, 2 * sizeof(Vec3f), sizeof(Vec3f));
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, indices, shape.indices);
    glBindVertexArray(0);
}

void SolidRenderer::Mesh::draw() const {
    glBindVertexArray(vertex_array);
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
}

Eigen::Matrix4f SolidRenderer::pose(const Part& part, const DrawFrame& frame) const {
    Eigen::Isometry3f pose = frame.solid_poses[part.solid];
    if (part.fades) {
        // An endless plane: its mesh follows to the point below the scene's centre.
        const Vec3f normal = pose.linear().col(1);
        pose.translation() = centre_ - normal * normal.dot(centre_ - pose.translation());
    }
    Eigen::Matrix4f matrix = pose.matrix();
    if (part.fades) matrix.topLeftCorner<3, 3>() *= reach_now_ / reach_;
    return matrix;
}

void SolidRenderer::draw_casters(const DrawFrame& frame, GLint transform_uniform,
                                 const Eigen::Matrix4f& transform, bool coarse) const {
    for (const Part& part : parts_) {
        if (part.fades) continue;  // nothing lies below a plane
        const Eigen::Matrix4f matrix = transform * pose(part, frame);
        glUniformMatrix4fv(transform_uniform, 1, GL_FALSE, matrix.data());
        (coarse ? part.coarse : part.fine).draw();
    }
}

void SolidRenderer::draw_shaded(const Part& part, const DrawFrame& frame) const {
    const Eigen::Matrix4f matrix = pose(part, frame);
    const Vec3f middle = matrix.block<3, 1>(0, 3);
    const SolidMesh& solid = scene_->solids[static_cast<std::size_t>(part.solid)];
    const Shaded& shaded = shaded_[part.program];
    shaded.program.use();
    if (shaded.variant.pictured) {
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, part.texture);
        // A plane's mesh is stretched over what it is to reach.
        glUniform1f(shaded.per_picture, (part.fades ? reach_now_ / reach_ : 1) / solid.texture_size);
    }
    glUniform1f(shaded.metal, solid.finish == SurfaceFinish::metal ? 1.f : 0.f);
    glUniformMatrix4fv(shaded.model, 1, GL_FALSE, matrix.data());
    glUniform3fv(shaded.albedo, 1, part.albedo.data());
    glUniform1f(shaded.gloss, part.fades || solid.finish == SurfaceFinish::matt ? 0.15f : 1.f);
    glUniform3fv(shaded.fade_centre, 1, middle.data());
    part.fine.draw();
}

void SolidRenderer::draw_shaded(const DrawFrame& frame) const {
    glEnable(GL_CULL_FACE);
    for (const Part& part : parts_)
        if (!part.fades) draw_shaded(part, frame);
    glDisable(GL_CULL_FACE);
}

void SolidRenderer::draw_planes(const DrawFrame& frame) const {
    glEnable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const Part& part : parts_)
        if (part.fades) draw_shaded(part, frame);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
}

void SolidRenderer::draw_quiet(const Part& part, const DrawFrame& frame,
                               const SurfaceUniforms& uniforms) const {
    Eigen::Matrix4f matrix = pose(part, frame);
    const Vec3f middle = matrix.block<3, 1>(0, 3);
    // Tones of the background that stay behind the wires.
    const Vec3f background = linear(scene_->components_background);
    const Vec3f tint =
        part.fades ? Vec3f(2.2f * background) : Vec3f(3.5f * background + Vec3f::Constant(0.04f));
    if (part.fades) matrix.block<3, 3>(0, 0) *= quiet_ground;
    glUniformMatrix4fv(uniforms.model, 1, GL_FALSE, matrix.data());
    glUniform3fv(uniforms.tint, 1, tint.data());
    glUniform1i(uniforms.fades, part.fades);
    glUniform3fv(uniforms.fade_centre, 1, middle.data());
    part.fine.draw();
}

void SolidRenderer::draw_quiet(const DrawFrame& frame, const SurfaceUniforms& uniforms) const {
    for (const Part& part : parts_)
        if (!part.fades) draw_quiet(part, frame, uniforms);
}

void SolidRenderer::draw_quiet_planes(const DrawFrame& frame, const SurfaceUniforms& uniforms) const {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const Part& part : parts_)
        if (part.fades) draw_quiet(part, frame, uniforms);
    glDisable(GL_BLEND);
}

}  // namespace unravel::render
