#pragma once

// What the renderer is given: plain geometry and colours. It knows nothing of springs or solvers;
// tool/picture/view.cpp makes these values from a scene and a simulated frame.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/image.hpp"

namespace unravel::render {

using Vec3f = Eigen::Vector3f;
using Vec2f = Eigen::Vector2f;

/// sRGB-encoded colour as a user writes it; the renderer converts to linear for shading.
struct Rgb {
    std::uint8_t r = 0, g = 0, b = 0;
    bool operator==(const Rgb&) const = default;
};

enum class WeavePattern { plain, twill, checks, stripes, solid };

struct ClothAppearance {
    WeavePattern weave = WeavePattern::checks;
    Rgb front{176, 58, 72}, front_second{242, 230, 216}, back{125, 42, 53};
    float period = 0.05f;  ///< m, of checks or stripes
    std::string texture;   ///< path of a PNG; empty: the weave
};

/// One cloth's fixed topology. Vertices are display vertices: a tube repeats its seam column so that uv stays
/// continuous; `particle` says which particle each takes its position from.
struct ClothMesh {
    std::vector<std::uint32_t> particle;  ///< (vertices) index into DrawFrame::positions
    std::vector<Vec2f> uv;                ///< (vertices) metres along the flat cloth
    std::vector<std::array<std::uint32_t, 3>>
        triangles;  ///< vertex indices, counter-clockwise from the front
    ClothAppearance appearance;
    Image texture;              ///< appearance.texture decoded, seen on the front; empty: the weave
    Vec2f picture_scale{1, 1};  ///< 1/m: uv times this places the picture as vt does: it spans [0, 1]², its
                                ///< lowest row at v = 0, and repeats beyond
};

/// A surface with its normals; triangles are counter-clockwise from outside.
struct Tessellation {
    std::vector<Vec3f> positions = {}, normals = {};  ///< (vertices) [m], unit
    std::vector<std::uint32_t> indices = {};          ///< (triangles × 3)
};

/// How a solid's surface takes the light: broad highlights, hardly any, sharp ones with what is around
/// mirrored in them, or those in the colour of the solid alone.
enum class SurfaceFinish { satin, matt, gloss, metal };

/// What is drawn of a solid, in its own frame: an endless plane facing +y, a surface that keeps its shape, or
/// a mesh whose normals follow from its triangles.
struct SolidMesh {
    bool plane = false;
    Tessellation fine = {}, coarse = {};  ///< a surface, for the eye and for shadows; coarse lies inside
    Vec3f half_extents{0, 0, 0};          ///< of the box about it, but for what deforms [m]
    std::vector<Vec3f> positions = {};    ///< mesh: (vertices) [m]
    std::vector<std::array<std::uint32_t, 3>> triangles = {};  ///< mesh: counter-clockwise from outside
    bool deforms = false;                                      ///< mesh: DrawFrame has its positions
    Rgb color{201, 183, 156};
    SurfaceFinish finish = SurfaceFinish::satin;
    Image texture = {};      ///< in place of the colour, laid on along the three axes; empty: none
    float texture_size = 1;  ///< m that it spans
    bool is_mesh() const { return !triangles.empty(); }
};

struct CameraView {
    Vec3f position{1.6f, 1.2f, 1.9f}, target{0, 0.3f, 0}, up{0, 1, 0};
    float fov = 35;      ///< degrees, vertical
    float aperture = 0;  ///< m, across the lens; pictures of final quality are sharp only at `focus` then
    float focus = 0;     ///< m from the camera; 0: the target's distance
    bool fit = false;  ///< stands where what is known of the clip beforehand fills the picture, see fitted()
};

/// Light beside the key light's direction. Colours are linear, strengths are shares of the usual.
struct Lighting {
    Vec3f key_color{1.0f, 0.965f, 0.91f};
    float key_strength = 1, key_radius = 0.05f;  ///< tangent of the lamp's radius: about six degrees across
    std::optional<Vec3f> sky_color;              ///< absent: a cool white with a share of the background
    float sky_strength = 1;
    Image sky;              ///< all directions (render/sky_light.hpp) in place of that colour; empty: none
    bool show_sky = false;  ///< as the background, too
    float exposure = 1;     ///< factor on all light
};

/// Fixed for a whole clip.
struct DrawScene {
    std::vector<ClothMesh> cloths;
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< particle pairs, the springs drawn as wires
    float spacing = 0.02f;                            ///< m, typical length of those springs at rest
    std::vector<SolidMesh> solids;
    Rgb background{216, 222, 230};
    std::optional<Rgb> background_top;  ///< of a gradient up from `background`
    Image background_image;             ///< fills the picture, before all other backgrounds but the sky
    bool transparent =
        false;  ///< neither background nor ground: alpha is what shapes cover, colours are straight
    bool show_ground = true;
    float ground_height = 0;  ///< m
    Rgb ground{141, 144, 150};
    Image ground_texture;                   ///< in place of that colour, repeated; empty: none
    float ground_size = 1;                  ///< m that the picture spans
    bool horizon = false;                   ///< the ground does not fade away near the scene
    Rgb components_background{27, 30, 36};  ///< of the component view: dark, so that white and every hue read
    Vec3f key_direction{-0.35f, 0.8f, 0.5f};  ///< towards the key light; need not be unit
    Lighting light;
    Vec3f bounds_low{-1, 0, -1},
        bounds_high{1, 1, 1};  ///< m, of what is known of the clip beforehand: the ground's extent
};

/// What changes from frame to frame.
struct DrawFrame {
    std::vector<Vec3f> positions = {};  ///< (particles) [m]
    std::vector<Rgb> particle_colors;   ///< (particles) component view: by component, white if constrained
    std::vector<std::uint8_t> edge_strength;  ///< (edges) 255 solid … 0 not drawn; empty: all solid
    std::vector<Rgb> edge_colors;  ///< (edges) colours of the wires; empty: those of the particles they join
    std::vector<Eigen::Isometry3f> solid_poses;  ///< (solids) shape's own frame to world
    /// (solids) vertices of meshes that deform, in their own frames [m]; empty lists for all others.
    std::vector<std::vector<Vec3f>> solid_positions;
    CameraView camera;
};

/// Cloth as it looks; wires in the colours of the frame; those wires on top of that cloth.
enum class DrawStyle { textured, components, overlay };

}  // namespace unravel::render
