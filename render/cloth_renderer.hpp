#pragma once

#include <span>
#include <vector>

#include "render/draw_scene.hpp"
#include "render/gl_objects.hpp"
#include "render/renderer.hpp"

namespace unravel::render {

/// The cloths as surfaces: into shadow maps, as fabric, and as the ground that wires are drawn on.
class ClothRenderer {
public:
    struct Options {
        bool software;    ///< the renderer pays for each triangle and pixel: very fine meshes then get their
                          ///< light at vertices and cast shadows by fewer triangles
        bool encoded;     ///< shaders write sRGB
        int supersample;  ///< drawn pixels along a side of a finished one
        Quality quality;  ///< drafts get their light at vertices, final pictures pixel by pixel
        std::string light;  ///< of light_defines.hpp
    };
    ClothRenderer(const DrawScene& scene, const Options& options);

    /// New positions and smooth normals.
    void update_shape(const DrawFrame& frame);
    /// New colours of the component view's surface: the particles' own, shaded by its tilt, so that folds are
    /// seen between wires, which keep their colours as they are.
    void update_colors(const DrawFrame& frame);

    /// Triangles only: position at attribute 0, colour at 3.
    void draw_shapes() const;
    /// The same in at most a few thousand triangles, for the small maps of sky light. Position only.
    void draw_coarse() const;
    /// The same in enough triangles for the key light's map: all but those of very fine meshes.
    void draw_casters() const;
    /// `pixels`: that a metre takes at a depth of 1 m.
    void draw_fabric(float pixels) const;

private:
    struct Vertex {
        Vec3f position, normal;
    };
    // Fewer triangles between the same vertices.
    struct Outline {
        GlVertexArray array;
        GlBuffer indices;
        GLsizei count = 0;
    };
    struct Cloth {
        const ClothMesh* mesh;
        GlProgram near, far;  ///< built for this cloth's weave, with its threads and without
        float thread;         ///< m between threads
        float distance = 0;   ///< m from the eye to the nearest particle
        GlVertexArray vertex_array;
        GlBuffer vertices, uvs, colors, indices;
        Outline casters, coarse;
        GlTexture texture;

        Cloth(const ClothMesh& of, const Options& options);
    };
    void draw_triangles(const Cloth& cloth) const;
    static void make_outline(const Cloth& cloth, std::size_t particles, Outline& outline);
    static void draw_outline(const Outline& outline);

    float supersample_;
    std::vector<Cloth> cloths_;
    std::vector<Vec3f> normals_;                               ///< (particles)
    std::vector<Vertex> scratch_;                              ///< of one cloth at a time
    std::vector<std::array<std::uint8_t, 4>> shaded_;          ///< (particles) sRGB
    std::vector<std::array<std::uint8_t, 4>> scratch_colors_;  ///< of one cloth at a time
};

}  // namespace unravel::render
