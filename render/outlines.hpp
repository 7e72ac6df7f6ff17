#pragma once

#include <vector>

#include "render/draw_scene.hpp"
#include "render/framebuffer.hpp"
#include "render/gl_objects.hpp"

namespace unravel::render {

/// Smooth outlines where a pixel has one sample. An edge of a mesh is part of an outline where the mesh ends,
/// or where one of its triangles faces the viewer and the other does not; a pixel that such an edge runs
/// through is mixed with its neighbour beyond the edge by the share of it that lies there.
/// [Persson 2011, Geometric post-process anti-aliasing]
class Outlines {
public:
    /// `encoded`: the picture is read and written as sRGB.
    Outlines(const DrawScene& scene, bool encoded);

    /// Finds the frame's outlines.
    void update(const DrawFrame& frame);
    /// Smooths them, all within `rect` of the picture.
    void draw(const Framebuffer& framebuffer, const PixelRect& rect) const;

private:
    struct Edge {
        std::uint32_t a, b;   ///< corners
        std::uint32_t left;   ///< triangle
        std::uint32_t right;  ///< the other one; `none`: the mesh ends here, or more than two meet
    };
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A cloth, whose corners are particles, or a solid.
    struct Surface {
        std::vector<std::array<std::uint32_t, 3>> triangles;
        std::vector<Edge> edges;
        std::vector<Vec3f> positions;  ///< of a solid that keeps its shape [m]
        int solid = -1;                ///< −1: a cloth
    };
    static void find_edges(Surface& surface);
    static Surface surface_of(const SolidMesh& solid, int index);
    void find_outlines(const Surface& surface, const DrawFrame& frame);

    const DrawScene* scene_;
    std::vector<Surface> surfaces_;
    std::vector<char> facing_;                ///< (triangles) of one surface at a time
    std::vector<std::array<float, 4>> ends_;  ///< two for each edge: place [m], whether it is a solid's
    std::size_t count_ = 0;                   ///< edges found
    GlBuffer points_, quads_;
    GlTexture points_table_;
    GlVertexArray vertex_array_;
    GlProgram smooth_;
};

}  // namespace unravel::render
