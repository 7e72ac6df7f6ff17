#pragma once

#include <span>
#include <vector>

#include "render/draw_scene.hpp"
#include "render/gl_objects.hpp"

namespace unravel {

/// The cloths as surfaces: into shadow maps, as fabric, and as the ground that wires are drawn on.
class ClothRenderer {
public:
    explicit ClothRenderer(const DrawScene& scene);

    /// New positions and smooth normals.
    void update_shape(const DrawFrame& frame);
    /// New colours of the component view: the particles' own, lightly shaded by the surface's tilt, so that
    /// folds are seen. The result holds until the next call.
    std::span<const std::array<std::uint8_t, 4>> update_colors(const DrawFrame& frame);

    /// Triangles only: position at attribute 0, colour at 3.
    void draw_shapes() const;
    /// The same in at most a few thousand triangles, for the small maps of sky light. Position only.
    void draw_coarse() const;
    void draw_fabric() const;

private:
    struct Vertex {
        Vec3f position, normal;
    };
    struct Cloth {
        const ClothMesh* mesh;
        GlProgram fabric;  ///< built for this cloth's weave
        GlVertexArray vertex_array;
        GlBuffer vertices, uvs, colors, indices, coarse_indices;
        GlVertexArray coarse_array;
        GLsizei coarse_count = 0;
        GlTexture texture;

        explicit Cloth(const ClothMesh& of);
    };
    void draw_triangles(const Cloth& cloth) const;

    std::vector<Cloth> cloths_;
    std::vector<Vec3f> normals_;                               ///< (particles)
    std::vector<Vertex> scratch_;                              ///< of one cloth at a time
    std::vector<std::array<std::uint8_t, 4>> shaded_;          ///< (particles) sRGB
    std::vector<std::array<std::uint8_t, 4>> scratch_colors_;  ///< of one cloth at a time
};

}  // namespace unravel
