#include "tool/study/stability/stability_picture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/camera.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

constexpr int width = 480, height = 270;
// Pixels: cloth that is no larger, and the ring about it.
constexpr float too_small = 30, ring_margin = 12, ring_width = 2;
constexpr float ring[3] = {230, 60, 40};

// What a cloth's particles cover of the picture [px].
struct Extent {
    Eigen::Array2f low = Eigen::Array2f::Constant(1e9f), high = -low;
    float size() const { return (high - low).maxCoeff(); }
    Eigen::Array2f centre() const { return 0.5f * (low + high); }
};

Extent extent_of(const DrawScene& scene, const DrawFrame& frame) {
    const Projection camera =
        make_camera(frame.camera, static_cast<float>(width) / height, scene.bounds_low, scene.bounds_high, 0);
    Extent extent;
    for (const Vec3f& x : frame.positions) {
        const Eigen::Vector4f clip = camera.projection * camera.view * x.homogeneous();
        if (clip.w() <= 0) continue;
        const Eigen::Array2f at{(0.5f + 0.5f * clip.x() / clip.w()) * width,
                                (0.5f - 0.5f * clip.y() / clip.w()) * height};
        extent.low = extent.low.min(at);
        extent.high = extent.high.max(at);
    }
    return extent;
}

void draw_ring(const Eigen::Array2f& centre, float radius, Image& image) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float r = std::hypot(x + 0.5f - centre.x(), y + 0.5f - centre.y());
            const float cover = std::clamp(0.5f * ring_width + 0.5f - std::abs(r - radius), 0.0f, 1.0f);
            std::uint8_t* const pixel = image.at(x, y);
            for (std::size_t c = 0; c < 3; ++c)
                pixel[c] = static_cast<std::uint8_t>(std::lround(std::lerp(pixel[c], ring[c], cover)));
        }
    }
}

}  // namespace

bool draw_hard_case(const GlContext& context, const HardOutcome& outcome, const std::filesystem::path& file) {
    if (!outcome.scene || outcome.last.state.x.empty()) return false;
    const Scene& scene = *outcome.scene;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    DrawFrame frame;
    make_draw_frame(scene, model, drawn, outcome.last, std::vector<Rgb>(model.size()), frame);
    Renderer renderer(context, drawn, {width, height, 4, 1});
    Image image;
    renderer.draw(DrawStyle::textured, frame, image);
    const Extent extent = extent_of(drawn, frame);
    if (extent.size() >= 0 && extent.size() < too_small)
        draw_ring(extent.centre(), 0.5f * extent.size() + ring_margin, image);
    write_png(file, image);
    return true;
}

}  // namespace unravel::tool
