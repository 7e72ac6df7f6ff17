// Drafts, and pictures that are the mean of many.
#include <cmath>
#include <numbers>

#include "render/color.hpp"
#include "render/renderer.hpp"
#include "render/sampling.hpp"
#include "tests/render/ball.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/pictures.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;
using testing::empty_scene;

namespace {

Image drawn(const GlContext& context, const DrawScene& scene, const DrawFrame& frame, Quality quality,
            int passes = 64) {
    Renderer renderer(context, scene,
                      {.width = 240, .height = 160, .samples = 0, .quality = quality, .passes = passes});
    Image image;
    renderer.draw(DrawStyle::textured, frame, image);
    return image;
}

double light(const Image& image, int x, int y) {
    return srgb_to_linear(image.at(x, y)[1] / 255.f);
}

double mean_difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) sum += std::abs(a.pixels[k] - b.pixels[k]);
    return sum / (0.75 * static_cast<double>(a.pixels.size()));
}

/// A black square 1 m above a grey one, seen from beneath it at an angle, its edge across the picture.
struct Edge {
    static constexpr float height = 1;
    DrawScene scene = empty_scene({0, 0, 0});
    DrawFrame frame;

    Edge() {
        scene.key_direction = {0, 1, 0};
        scene.light.sky_strength = 0;
        const auto add = [&](Rgb color, const Vec3f& middle) {
            SolidMesh board = testing::box({4, 0.02, 4}, color);
            board.finish = SurfaceFinish::matt;
            scene.solids.push_back(board);
            Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
            pose.translation() = middle;
            frame.solid_poses.push_back(pose);
        };
        add({120, 120, 120}, {0, -0.01f, 0});     // dim enough for no tones to be pressed
        add({0, 0, 0}, {-2, height + 0.01f, 0});  // its edge at x = 0
        frame.camera = {.position = {0.4f, 0.9f, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}, .fov = 20};
        scene.bounds_low = {-4, 0, -2};
        scene.bounds_high = {2, 1.02f, 2};
    }
};

}  // namespace

TEST_CASE("samples_spread_evenly_over_lamp_lens_pixel_and_sky") {
    constexpr int n = 64;
    Vec2f pixel = Vec2f::Zero(), lamp = pixel, lens = pixel;
    double lamp2 = 0, up = 0, up2 = 0;
    for (int k = 0; k < n; ++k) {
        const Sample sample = sample_at(k);
        CHECK(sample.pixel.cwiseAbs().maxCoeff() <= 0.5f);
        CHECK(sample.lamp.norm() <= 1);
        CHECK(sample.lens.norm() <= 1);
        CHECK(sample.sky.norm() == Approx(1));
        CHECK(sample.sky.y() >= 0);
        pixel += sample.pixel / n;
        lamp += sample.lamp / n;
        lens += sample.lens / n;
        lamp2 += sample.lamp.squaredNorm() / n;
        up += sample.sky.y() / n;
        up2 += sample.sky.y() * sample.sky.y() / n;
    }
    // Random samples would be off by one part in eight; these by a few in a hundred.
    CHECK(pixel.norm() < 0.03);
    CHECK(lamp.norm() < 0.05);
    CHECK(lens.norm() < 0.05);
    CHECK(lamp2 == Approx(0.5).margin(0.03));
    CHECK(up == Approx(0.5).margin(0.02));
    CHECK(up2 == Approx(1 / 3.0).margin(0.02));
}

TEST_CASE("GL_the_penumbra_of_a_final_picture_is_that_of_a_round_lamp") {
    const auto context = testing::open_renderer();
    if (!context) return;
    const Edge edge;
    const Image image = drawn(*context, edge.scene, edge.frame, Quality::final_, 128);
    // A lamp of angular radius r over a straight edge h above: at x from below the edge the share of the disk
    // that is seen is what a chord at x / (h r) from its middle cuts off.
    DrawScene open = edge.scene;
    open.solids.pop_back();
    DrawFrame nothing = edge.frame;
    nothing.solid_poses.pop_back();
    const Image all = drawn(*context, open, nothing, Quality::final_, 8);
    const double reach = Edge::height * edge.scene.light.key_radius;
    double worst = 0;
    for (int x = 2; x < 238; ++x) {
        // Where the middle of the pixel's column meets the ground: the camera looks along the x–y plane.
        const double half = std::tan(10 * std::numbers::pi / 180) * 1.5;
        const double turn = std::atan(half * (x + 0.5 - 120) / 120);
        // The picture's right is +x: from the camera down and to the target, turned about z.
        const double down = std::atan2(0.4, 0.9) - turn;
        const double place = 0.4 - 0.9 * std::tan(down);
        const double t = std::clamp(place / reach, -1.0, 1.0);
        const double share = 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / std::numbers::pi;
        worst = std::max(worst, std::abs(light(image, x, 80) / light(all, x, 80) - share));
    }
    // 128 points on the lamp, and maps of a texel of 5 mm: a twentieth of the penumbra.
    CHECK(worst < 0.08);
}

TEST_CASE("GL_a_final_picture_is_the_standard_one_with_finer_light") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(41);
    sheet.scene.cloths[0].appearance.weave = WeavePattern::solid;
    const Image standard = drawn(*context, sheet.scene, sheet.frame, Quality::standard);
    const Image final = drawn(*context, sheet.scene, sheet.frame, Quality::final_);
    const Image finer = drawn(*context, sheet.scene, sheet.frame, Quality::final_, 256);
    const Image draft = drawn(*context, sheet.scene, sheet.frame, Quality::draft);
    INFO("standard " << mean_difference(standard, finer) << ", final " << mean_difference(final, finer)
                     << ", draft " << mean_difference(draft, finer));
    CHECK(mean_difference(final, finer) < 1);
    CHECK(mean_difference(standard, finer) < 4);
    CHECK(mean_difference(draft, finer) < 14);
    CHECK(mean_difference(draft, standard) > 0.2);
}

TEST_CASE("GL_depth_of_field_blurs_what_is_not_in_focus_and_nothing_else") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // Two white balls against black, one in focus and one twice as far away.
    DrawScene scene = empty_scene({0, 0, 0});
    DrawFrame frame;
    for (const float x : {-0.35f, 0.7f}) {
        scene.solids.push_back(testing::ball(x < 0 ? 0.2f : 0.4f, {255, 255, 255}));
        Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
        pose.translation() = Vec3f(x, 0, x < 0 ? 0 : -2);
        frame.solid_poses.push_back(pose);
    }
    frame.camera = {.position = {0, 0, 2}, .target = {0, 0, 0}, .fov = 40};
    // The largest step of light along the row through both, from pixel to pixel.
    const auto steepest = [&](float aperture, int from, int to) {
        frame.camera.aperture = aperture;
        const Image image = drawn(*context, scene, frame, Quality::final_);
        double most = 0;
        for (int x = from + 1; x < to; ++x)
            most = std::max(most, std::abs(light(image, x, 80) - light(image, x - 1, 80)));
        return most;
    };
    CHECK(steepest(0.2f, 0, 120) > 0.8 * steepest(0, 0, 120));
    // Blurred over 0.2 m (1/2 − 1/4)/m of the picture: 11 px.
    CHECK(steepest(0.2f, 120, 240) < 0.5 * steepest(0, 120, 240));
}
