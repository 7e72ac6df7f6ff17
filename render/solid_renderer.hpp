#pragma once

#include <algorithm>
#include <vector>

#include "render/draw_scene.hpp"
#include "render/gl_objects.hpp"
#include "render/solid_shapes.hpp"

namespace unravel::render {

/// Solids. Planes fade away with distance from the scene.
class SolidRenderer {
public:
    /// `encoded`: shaders write sRGB. `light`: of light_defines.hpp.
    SolidRenderer(const DrawScene& scene, bool encoded, const std::string& light);

    /// Uploads the frame's positions of meshes that deform. Before anything else of the frame is drawn.
    void update_shapes(const DrawFrame& frame);

    /// How far planes go from the scene's centre in this frame [m]: 2.5 times the scene's diagonal, or
    /// further.
    float set_reach(float at_least) { return reach_now_ = std::max(reach_, at_least); }

    /// What casts shadows, by the program in use, whose matrix `transform` is set for each. `coarse`: for
    /// small maps.
    void draw_casters(const DrawFrame& frame, GLint transform_uniform, const Eigen::Matrix4f& transform,
                      bool coarse) const;
    /// All but planes.
    void draw_shaded(const DrawFrame& frame) const;
    /// Planes, over what is behind them already: where they fade, that is to be seen.
    void draw_planes(const DrawFrame& frame) const;
    /// The component view's quiet versions of both, by the program in use.
    struct SurfaceUniforms {
        GLint model, tint, fades, fade_centre;
    };
    void draw_quiet(const DrawFrame& frame, const SurfaceUniforms& uniforms) const;
    void draw_quiet_planes(const DrawFrame& frame, const SurfaceUniforms& uniforms) const;

private:
    struct Mesh {
        GlVertexArray vertex_array;
        GlBuffer vertices, indices;
        GLsizei count = 0;

        explicit Mesh(const Tessellation& shape);
        void update(const Tessellation& shape);
        void draw() const;
    };
    struct Part {
        Mesh fine, coarse;
        int solid = 0;
        bool fades = false;
        Vec3f albedo;              ///< linear
        std::size_t program = 0;   ///< of shaded_
        CreasedMesh creased = {};  ///< of a mesh that deforms
        GlTexture texture = {};
    };
    Eigen::Matrix4f pose(const Part& part, const DrawFrame& frame) const;
    void draw_shaded(const Part& part, const DrawFrame& frame) const;
    void draw_quiet(const Part& part, const DrawFrame& frame, const SurfaceUniforms& uniforms) const;

    const DrawScene* scene_;
    Vec3f centre_;
    float reach_, reach_now_;
    std::vector<Part> parts_;
    // What asks for a program of its own: planes, which fade, sharp highlights, and pictures.
    struct Variant {
        bool fades = false, polished = false, pictured = false;
        bool operator==(const Variant&) const = default;
    };
    struct Shaded {
        Variant variant;
        GlProgram program;
        GLint model, albedo, gloss, fade_centre, metal, per_picture;

        Shaded(const Variant& of, bool encoded, const std::string& light);
    };
    std::size_t program_of(const Variant& variant, bool encoded, const std::string& light);
    std::vector<Shaded> shaded_;
};

}  // namespace unravel::render
