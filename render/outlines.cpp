#include "render/outlines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace unravel::render {

void Outlines::find_edges(Surface& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        const auto& corners = surface.triangles[t];
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = std::min(corners[k], corners[(k + 1) % 3]),
                                b = std::max(corners[k], corners[(k + 1) % 3]);
            if (a == b) continue;
            const auto [found, is_new] =
                known.try_emplace({a, b}, static_cast<std::uint32_t>(surface.edges.size()));
            if (is_new) {
                surface.edges.push_back({a, b, t, none});
                continue;
            }
            Edge& edge = surface.edges[found->second];
            edge.right = edge.right == none ? t : none;
        }
    }
}

/// A solid's triangles, with corners at the same place made one.
Outlines::Surface Outlines::surface_of(const SolidMesh& solid, int index) {
    Surface surface;
    surface.solid = index;
    if (solid.is_mesh()) {
        surface.triangles.assign(solid.triangles.begin(), solid.triangles.end());
        surface.positions = solid.positions;
        return surface;
    }
    const Tessellation& shape = solid.fine;
    std::map<std::array<long, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> corner;
    for (const Vec3f& x : shape.positions) {
        const auto rounded = [&](int i) { return std::lround(1e5f * x[i]); };  // hundredths of a millimetre
        const auto [found, is_new] = known.try_emplace({rounded(0), rounded(1), rounded(2)},
                                                       static_cast<std::uint32_t>(surface.positions.size()));
        if (is_new) surface.positions.push_back(x);
        corner.push_back(found->second);
    }
    for (std::size_t k = 0; k + 2 < shape.indices.size(); k += 3) {
        const std::uint32_t a = corner[shape.indices[k]], b = corner[shape.indices[k + 1]],
                            c = corner[shape.indices[k + 2]];
        if (a != b && b != c && c != a) surface.triangles.push_back({a, b, c});
    }
    return surface;
}

Outlines::Outlines(const DrawScene& scene, bool encoded)
    : scene_(&scene),
      smooth_({"frame.glsl", "outline.vert"}, {"outline.frag"},
              fmt::format("#define ENCODED {}\n", encoded ? 1 : 0)) {
    for (const ClothMesh& mesh : scene.cloths) {
        Surface& surface = surfaces_.emplace_back();
        for (const auto& [a, b, c] : mesh.triangles)
            surface.triangles.push_back({mesh.particle[a], mesh.particle[b], mesh.particle[c]});
    }
    for (std::size_t s = 0; s < scene.solids.size(); ++s)
        if (!scene.solids[s].plane) surfaces_.push_back(surface_of(scene.solids[s], static_cast<int>(s)));
    std::size_t edges = 0, triangles = 0;
    for (Surface& surface : surfaces_) {
        find_edges(surface);
        edges += surface.edges.size();
        triangles = std::max(triangles, surface.triangles.size());
    }
    facing_.resize(triangles);
    ends_.resize(std::max<std::size_t>(2 * edges, 1));
    allocate_buffer(GL_TEXTURE_BUFFER, points_, ends_.size() * sizeof ends_[0]);
    glBindTexture(GL_TEXTURE_BUFFER, points_table_);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, points_);
    glBindVertexArray(vertex_array_);
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, quads_, quad_indices(edges));
    glBindVertexArray(0);
    smooth_.sampler("picture", 0);
    smooth_.sampler("depth", 1);
    smooth_.sampler("ends", 2);
}

void Outlines::find_outlines(const Surface& surface, const DrawFrame& frame) {
    const bool is_solid = surface.solid >= 0;
    const auto s = static_cast<std::size_t>(std::max(surface.solid, 0));
    const Eigen::Isometry3f pose = is_solid ? frame.solid_poses[s] : Eigen::Isometry3f::Identity();
    const std::vector<Vec3f>& x = !is_solid                   ? frame.positions
                                  : scene_->solids[s].deforms ? frame.solid_positions[s]
                                                              : surface.positions;
    const Vec3f eye = pose.inverse() * frame.camera.position;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto& [a, b, c] = surface.triangles[t];
        facing_[t] = (x[b] - x[a]).cross(x[c] - x[a]).dot(eye - x[a]) > 0 ? 1 : 0;
    }
    for (const Edge& edge : surface.edges) {
        if (edge.right != none && facing_[edge.left] == facing_[edge.right]) continue;
        for (const std::uint32_t corner : {edge.a, edge.b}) {
            const Vec3f p = pose * x[corner];
            ends_[count_++] = {p.x(), p.y(), p.z(), is_solid ? 1.f : 0.f};
        }
    }
}

void Outlines::update(const DrawFrame& frame) {
    count_ = 0;
    for (const Surface& surface : surfaces_) find_outlines(surface, frame);
    update_buffer(GL_TEXTURE_BUFFER, points_, std::span(ends_).first(count_));
    count_ /= 2;
}

void Outlines::draw(const Framebuffer& framebuffer, const PixelRect& rect) const {
    if (count_ == 0 || rect.empty()) return;
    framebuffer.begin_outlines(rect);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_BUFFER, points_table_);
    smooth_.use();
    glBindVertexArray(vertex_array_);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * count_), GL_UNSIGNED_INT, nullptr);
}

}  // namespace unravel::render
