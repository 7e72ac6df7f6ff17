#pragma once

#include <span>

#include "render/draw_scene.hpp"
#include "render/gl_objects.hpp"

namespace unravel::render {

/// Springs as lines and particles as dots, in the particles' colours, with widths that follow the picture's
/// height.
class WireRenderer {
public:
    explicit WireRenderer(const DrawScene& scene);

    void update(const DrawFrame& frame);
    /// `height`: of the picture being drawn [px]; `gap`: pixels between neighbouring particles at the scene's
    /// centre. Nothing is drawn where springs are too dense to be told apart.
    /// `encoded`: shaders write sRGB.
    void draw(int height, float gap, bool encoded) const;

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
    float spacing_;
    std::vector<std::array<float, 4>> scratch_points_;
    std::vector<std::array<std::uint8_t, 4>> scratch_colors_;
    bool by_edge_ = false;             ///< edges have colours of their own
    std::vector<std::uint8_t> solid_;  ///< (edges) 255: what an empty edge_strength means
    Table points_, colors_, edge_table_, strengths_, edge_colors_;
    GlVertexArray vertex_array_;
    GlBuffer quads_;
    GlProgram wire_, dot_;
    GLint width_, wire_spacing_, own_colors_, wire_encoded_, radius_, dot_strength_, dot_encoded_;
};

}  // namespace unravel::render
