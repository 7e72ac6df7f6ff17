#pragma once

#include <span>
#include <vector>

#include "render/draw_scene.hpp"
#include "render/solid_shapes.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A point on a page: x, y from the upper left [px], and its depth before the camera [m]; not positive: it is
/// behind the camera.
struct PagePoint {
    float x = 0, y = 0, depth = 0;
};

/// How a frame's camera throws points onto a page.
class PageView {
public:
    PageView(const CameraView& camera, int width, int height);
    PagePoint operator()(const Vec3f& p) const;
    /// Pixels that a metre takes at a depth of 1 m.
    float pixels() const { return pixels_; }
    int width() const { return width_; }
    int height() const { return height_; }
    const Vec3f& eye() const { return eye_; }

private:
    Eigen::Matrix4f view_;
    Vec3f eye_;
    float pixels_;
    int width_, height_;
};

/// The solids of a figure: what of them faces the viewer, and which cells of cloth are behind which.
class FigureSolids {
public:
    explicit FigureSolids(const DrawScene& scene);

    struct Triangle {
        std::array<PagePoint, 3> corner;
        float shade = 1;  ///< 1 facing the lamp … 0
    };
    /// One solid as it is seen. Of several the farthest is the first.
    struct Layer {
        std::size_t solid = 0;
        float distance = 0;                 ///< m
        std::vector<Triangle> triangles{};  ///< far ones first
        std::vector<float> nearest{};       ///< (map) depth of what is seen, or infinity
    };
    /// `lamp`: direction towards it.
    std::vector<Layer> seen(const DrawFrame& frame, const PageView& view, const Vec3f& lamp) const;

    /// The first layer that a polygon is behind, by most of the places where it meets one; as many as there
    /// are: it is before all. What is less than `yields` [m] behind is taken to be before.
    static std::size_t layer_of(std::span<const PagePoint> corners, const std::vector<Layer>& layers,
                                const PageView& view, float yields);

private:
    const DrawScene* scene_;
    std::vector<CreasedMesh> creased_;  ///< (solids) of meshes
};

}  // namespace unravel::tool
