#include "render/wire_renderer.hpp"

#include <algorithm>

namespace unravel::render {

namespace {

constexpr float sparse_gap =
    3.5f;  // px between particles above which they are dots, in full from twice that on
constexpr float invisible_gap = 1.2f;  // px; wire.vert lets springs vanish as they come near it

}  // namespace

void WireRenderer::make_table(const Table& table, GLenum format, std::size_t bytes) {
    // A table of nothing is not allowed: keep room for one entry.
    allocate_buffer(GL_TEXTURE_BUFFER, table.buffer, std::max<std::size_t>(bytes, 16));
    glBindTexture(GL_TEXTURE_BUFFER, table.texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, table.buffer);
}

WireRenderer::WireRenderer(const DrawScene& scene)
    : spacing_(scene.spacing),
      wire_({"frame.glsl", "color.glsl", "wire.vert"}, {"color.glsl", "wire.frag"}),
      dot_({"frame.glsl", "color.glsl", "dot.vert"}, {"color.glsl", "dot.frag"}),
      width_(wire_.uniform("width")),
      wire_spacing_(wire_.uniform("spacing")),
      own_colors_(wire_.uniform("own_colors")),
      wire_encoded_(wire_.uniform("encodes")),
      radius_(dot_.uniform("radius")),
      dot_strength_(dot_.uniform("strength")),
      dot_encoded_(dot_.uniform("encodes")) {
    // Display vertices between particles are no ends of springs.
    for (const auto& [a, b] : scene.edges) particles_ = std::max<std::size_t>(particles_, std::max(a, b) + 1);
    edges_ = scene.edges.size();
    make_table(points_, GL_RGBA32F, 16 * particles_);
    make_table(colors_, GL_RGBA8, 4 * particles_);
    make_table(edge_table_, GL_RG32UI, 8 * edges_);
    make_table(strengths_, GL_R8, edges_);
    make_table(edge_colors_, GL_RGBA8, 4 * edges_);
    update_buffer(GL_TEXTURE_BUFFER, edge_table_.buffer, scene.edges);
    solid_.assign(edges_, 255);
    scratch_points_.resize(particles_);
    scratch_colors_.resize(std::max(particles_, edges_));

    glBindVertexArray(vertex_array_);
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, quads_, quad_indices(std::max(edges_, particles_)));
    glBindVertexArray(0);

    wire_.sampler("points", 0);
    wire_.sampler("colors", 1);
    wire_.sampler("edges", 2);
    wire_.sampler("strengths", 3);
    wire_.sampler("edge_colors", 4);
    dot_.sampler("points", 0);
    dot_.sampler("colors", 1);
}

void WireRenderer::update(const DrawFrame& frame) {
    for (std::size_t i = 0; i < particles_; ++i) {
        const Vec3f& p = frame.positions[i];
        scratch_points_[i] = {p.x(), p.y(), p.z(), 1};
    }
    update_buffer(GL_TEXTURE_BUFFER, points_.buffer, scratch_points_);
    const auto upload = [&](const Table& table, std::span<const Rgb> colors) {
        for (std::size_t i = 0; i < colors.size(); ++i)
            scratch_colors_[i] = {colors[i].r, colors[i].g, colors[i].b, 255};
        update_buffer(GL_TEXTURE_BUFFER, table.buffer, std::span(scratch_colors_).first(colors.size()));
    };
    upload(colors_, std::span(frame.particle_colors).first(particles_));
    by_edge_ = !frame.edge_colors.empty();
    if (by_edge_) upload(edge_colors_, frame.edge_colors);
    update_buffer(GL_TEXTURE_BUFFER, strengths_.buffer,
                  frame.edge_strength.empty() ? solid_ : frame.edge_strength);
}

void WireRenderer::bind_tables() const {
    int unit = 0;
    for (const Table* table : {&points_, &colors_, &edge_table_, &strengths_, &edge_colors_}) {
        glActiveTexture(GL_TEXTURE0 + unit++);
        glBindTexture(GL_TEXTURE_BUFFER, table->texture);
    }
}

void WireRenderer::draw(int height, float gap, bool encoded) const {
    if (gap < invisible_gap) return;
    bind_tables();
    glBindVertexArray(vertex_array_);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    wire_.use();
    glUniform1f(width_, line_width(height));
    glUniform1f(wire_spacing_, spacing_);
    glUniform1i(own_colors_, by_edge_ ? 1 : 0);
    glUniform1i(wire_encoded_, encoded ? 1 : 0);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * edges_), GL_UNSIGNED_INT, nullptr);

    // Dots come in where they leave the lines between them in sight.
    const float radius = std::min(1.5f * line_width(height), 0.22f * gap);
    const float strength = std::clamp((gap - sparse_gap) / sparse_gap, 0.f, 1.f);
    if (strength > 0) {
        dot_.use();
        glUniform1f(radius_, radius);
        glUniform1f(dot_strength_, strength);
        glUniform1i(dot_encoded_, encoded ? 1 : 0);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * particles_), GL_UNSIGNED_INT, nullptr);
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

}  // namespace unravel::render
