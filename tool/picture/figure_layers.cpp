#include "tool/picture/figure_layers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/camera.hpp"

namespace unravel::tool {

namespace {

constexpr int map_width = 480;  // of a layer's depths; its height is in proportion

struct MapSize {
    int width, height;
    float scale;  // of a page's pixels
};

MapSize map_size(const PageView& view) {
    const float scale = static_cast<float>(map_width) / static_cast<float>(view.width());
    return {map_width, std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(view.height())))),
            scale};
}

// Calls visit(place in the map, depth) for the pixels whose middles a triangle covers, and, were they none,
// for the one it is in. Depth is taken to be linear over so small a part of the page.
template <class Visit>
void cover(const std::array<PagePoint, 3>& t, const MapSize& size, Visit&& visit) {
    std::array<float, 3> x{}, y{};
    for (std::size_t k = 0; k < 3; ++k) {
        if (!(t[k].depth > 0)) return;
        x[k] = t[k].x * size.scale - 0.5f;
        y[k] = t[k].y * size.scale - 0.5f;
    }
    const auto [left, right] = std::ranges::minmax(x);
    const auto [top, bottom] = std::ranges::minmax(y);
    const float area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const int x0 = std::max(0, static_cast<int>(std::ceil(std::max(left, -1.f)))),
              x1 = std::min(size.width - 1, static_cast<int>(std::floor(std::min(right, 1e6f)))),
              y0 = std::max(0, static_cast<int>(std::ceil(std::max(top, -1.f)))),
              y1 = std::min(size.height - 1, static_cast<int>(std::floor(std::min(bottom, 1e6f))));
    bool any = false;
    if (std::abs(area) > 1e-6f) {
        for (int j = y0; j <= y1; ++j)
            for (int i = x0; i <= x1; ++i) {
                const auto px = static_cast<float>(i), py = static_cast<float>(j);
                const float b = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / area;
                const float c = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / area;
                if (b < 0 || c < 0 || b + c > 1) continue;
                any = true;
                visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(size.width) +
                          static_cast<std::size_t>(i),
                      (1 - b - c) * t[0].depth + b * t[1].depth + c * t[2].depth);
            }
    }
    const float middle_x = (x[0] + x[1] + x[2]) / 3 + 0.5f, middle_y = (y[0] + y[1] + y[2]) / 3 + 0.5f;
    if (any || middle_x < 0 || middle_y < 0 || middle_x >= static_cast<float>(size.width) ||
        middle_y >= static_cast<float>(size.height))
        return;
    visit(static_cast<std::size_t>(middle_y) * static_cast<std::size_t>(size.width) +
              static_cast<std::size_t>(middle_x),
          (t[0].depth + t[1].depth + t[2].depth) / 3);
}

}  // namespace

PageView::PageView(const CameraView& camera, int width, int height)
    : view_(look_at(camera.position, camera.target, camera.up)),
      eye_(camera.position),
      pixels_(0.5f * static_cast<float>(height) /
              std::tan(0.5f * camera.fov * std::numbers::pi_v<float> / 180)),
      width_(width),
      height_(height) {}

PagePoint PageView::operator()(const Vec3f& p) const {
    const Vec3f at = view_.topLeftCorner<3, 3>() * p + view_.topRightCorner<3, 1>();
    const float depth = -at.z();
    if (!(depth > 1e-3f)) return {};
    return {0.5f * static_cast<float>(width_) + pixels_ * at.x() / depth,
            0.5f * static_cast<float>(height_) - pixels_ * at.y() / depth, depth};
}

FigureSolids::FigureSolids(const DrawScene& scene) : scene_(&scene) {
    for (const SolidMesh& solid : scene.solids)
        creased_.push_back(solid.is_mesh() ? crease(solid.triangles, solid.positions) : CreasedMesh{});
}

std::vector<FigureSolids::Layer> FigureSolids::seen(const DrawFrame& frame, const PageView& view,
                                                    const Vec3f& lamp) const {
    const MapSize size = map_size(view);
    std::vector<Layer> layers;
    for (std::size_t s = 0; s < scene_->solids.size(); ++s) {
        const SolidMesh& solid = scene_->solids[s];
        const Tessellation of_mesh =
            solid.is_mesh()
                ? tessellate_mesh(creased_[s], solid.deforms ? frame.solid_positions[s] : solid.positions)
                : Tessellation{};
        const Tessellation& shape = solid.is_mesh() ? of_mesh : solid.fine;
        if (shape.indices.empty()) continue;
        const Eigen::Isometry3f& pose = frame.solid_poses[s];
        Layer layer{.solid = s};
        layer.nearest.assign(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height),
                             std::numeric_limits<float>::infinity());
        Vec3f middle = Vec3f::Zero();
        std::vector<Vec3f> placed;
        for (const Vec3f& x : shape.positions) {
            placed.push_back(pose * x);
            middle += placed.back() / static_cast<float>(shape.positions.size());
        }
        layer.distance = (middle - view.eye()).norm();
        for (std::size_t k = 0; k + 2 < shape.indices.size(); k += 3) {
            const std::array<std::uint32_t, 3> v{shape.indices[k], shape.indices[k + 1],
                                                 shape.indices[k + 2]};
            const Vec3f normal = (placed[v[1]] - placed[v[0]]).cross(placed[v[2]] - placed[v[0]]);
            if (normal.dot(view.eye() - placed[v[0]]) <= 0) continue;
            Triangle triangle{.corner = {view(placed[v[0]]), view(placed[v[1]]), view(placed[v[2]])}};
            if (std::ranges::any_of(triangle.corner, [](const PagePoint& p) { return !(p.depth > 0); }))
                continue;
            Vec3f smooth = Vec3f::Zero();
            for (const std::uint32_t i : v) smooth += pose.linear() * shape.normals[i];
            triangle.shade = std::clamp(0.5f + 0.5f * smooth.normalized().dot(lamp), 0.f, 1.f);
            cover(triangle.corner, size, [&](std::size_t at, float depth) {
                layer.nearest[at] = std::min(layer.nearest[at], depth);
            });
            layer.triangles.push_back(triangle);
        }
        std::ranges::stable_sort(layer.triangles, std::greater{}, [](const Triangle& t) {
            return t.corner[0].depth + t.corner[1].depth + t.corner[2].depth;
        });
        layers.push_back(std::move(layer));
    }
    std::ranges::stable_sort(layers, std::greater{}, &Layer::distance);
    return layers;
}

std::size_t FigureSolids::layer_of(std::span<const PagePoint> corners, const std::vector<Layer>& layers,
                                   const PageView& view, float yields) {
    const MapSize size = map_size(view);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        int behind = 0, before = 0;
        for (std::size_t k = 2; k < corners.size(); ++k)
            cover({corners[0], corners[k - 1], corners[k]}, size, [&](std::size_t at, float depth) {
                const float solid = layers[l].nearest[at];
                if (std::isfinite(solid)) ++(depth > solid + yields ? behind : before);
            });
        if (behind > before) return l;
    }
    return layers.size();
}

}  // namespace unravel::tool
