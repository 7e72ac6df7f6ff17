#pragma once

#include <span>

#include "render/draw_scene.hpp"
#include "render/gl_objects.hpp"

namespace unravel {

/// Springs as lines and particles as dots, in the particles' colours, with widths that follow the picture's
/// height.
class WireRenderer {
public:
    explicit WireRenderer(const DrawScene& scene);

    /// `colors` (particles): sRGB.
    void update(const DrawFrame& frame, std::span<const std::array<std::uint8_t, 4>> colors);
    /// Typical length of a spring at rest [m].
    float spacing() const { return spacing_; }
    /// `height`: of the picture being drawn [px]; `gap`: pixels between neighbouring particles at the scene's
    /// centre. Nothing is drawn where springs are too dense to be told apart.
    void draw(int height, float gap) const;

    /// Width of a line [px] in a picture of this height, where springs are not too dense for it.
    static float line_width(int height) { return 2.0f * static_cast<float>(height) / 720; }

private:
    /// A buffer that shaders read by index.
    struct Table {
        GlBuffer buffer;
        GlTexture texture;
    };
    static void make_table(const Table& table, GLenum format, std::size_t bytes);
    void bind_tables() const;

    std::size_t particles_ = 0, edges_ = 0;
    float spacing_ = 0.01f;
    std::vector<std::array<float, 4>> scratch_points_;
    std::vector<std::uint8_t> solid_;  ///< (edges) 255: what an empty edge_strength means
    Table points_, colors_, edge_table_, strengths_;
    GlVertexArray vertex_array_;
    GlBuffer quads_;
    GlProgram wire_, dot_;
    GLint width_, wire_spacing_, radius_;
};

}  // namespace unravel
