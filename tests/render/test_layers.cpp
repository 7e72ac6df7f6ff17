// What lies between shading and the finished picture: outlines, alpha, exposures.
#include <cmath>

#include "render/color.hpp"
#include "render/renderer.hpp"
#include "tests/render/ball.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/pictures.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;
using testing::empty_scene, testing::pixel;

TEST_CASE("GL_a_transparent_frame_has_the_opaque_ones_colours_and_alpha_where_shapes_are") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(31);
    sheet.scene.show_ground = false;
    DrawScene transparent = sheet.scene;
    transparent.transparent = true;
    for (const int supersample : {1, 2}) {
        const RenderSettings settings{.width = 160, .height = 90, .samples = 4, .supersample = supersample};
        Renderer opaque(*context, sheet.scene, settings), clear(*context, transparent, settings);
        Image a, b;
        opaque.draw(DrawStyle::textured, sheet.frame, a);
        clear.draw(DrawStyle::textured, sheet.frame, b);
        CHECK(b.at(0, 0)[3] == 0);
        int solid = 0, rim = 0, worst = 0;
        for (int y = 0; y < 90; ++y)
            for (int x = 0; x < 160; ++x) {
                const int alpha = b.at(x, y)[3];
                solid += alpha == 255;
                rim += alpha > 0 && alpha < 255;
                if (alpha == 255)
                    for (int c = 0; c < 3; ++c)
                        worst = std::max(worst, std::abs(a.at(x, y)[c] - b.at(x, y)[c]));
            }
        CHECK(solid > 1000);
        CHECK(rim > 50);
        // Each of the two rounds to a step of its own, and where it is split by an approximate reciprocal of
        // alpha (the processor's) it may come to the next one.
        CHECK(worst <= 2);
    }
}

TEST_CASE("GL_exposures_are_averaged_in_light") {
    const auto context = testing::open_renderer();
    if (!context) return;
    const testing::Sheet sheet(31);
    Renderer renderer(*context, sheet.scene, {.width = 160, .height = 90, .samples = 4, .exposures = true});
    Image one, many;
    renderer.draw(DrawStyle::textured, sheet.frame, one);
    renderer.submit(DrawStyle::textured, std::vector<DrawFrame>(5, sheet.frame));
    renderer.collect(many);
    int worst = 0;
    for (std::size_t k = 0; k < one.pixels.size(); ++k)
        worst = std::max(worst, std::abs(one.pixels[k] - many.pixels[k]));
    CHECK(worst <= 1);
    // A white ball that is there for one of two exposures leaves half its light.
    DrawScene scene = empty_scene({0, 0, 0});
    scene.solids.push_back(testing::ball(0.5f, {255, 255, 255}));
    std::vector<DrawFrame> frames(2);
    for (DrawFrame& frame : frames) {
        frame.solid_poses.push_back(Eigen::Isometry3f::Identity());
        frame.camera = {.position = {0, 0, 4}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
    }
    frames[1].solid_poses[0].translation() = Vec3f(50, 0, 0);
    Renderer halves(*context, scene, {.width = 64, .height = 64, .samples = 4, .exposures = true});
    halves.draw(DrawStyle::textured, frames[0], one);
    halves.submit(DrawStyle::textured, frames);
    halves.collect(many);
    CHECK(srgb_to_linear(many.at(32, 32)[0] / 255.f) ==
          Approx(0.5f * srgb_to_linear(one.at(32, 32)[0] / 255.f)).epsilon(0.03));
    CHECK_THROWS_AS(
        Renderer(*context, scene, {.width = 64, .height = 64}).submit(DrawStyle::textured, frames),
        std::invalid_argument);
}

TEST_CASE("GL_smooth_outlines_come_as_near_to_the_finest_picture_as_samples_do") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // Nothing but outlines: one colour, no shadows on a ground.
    testing::Sheet sheet(51);
    sheet.scene.show_ground = false;
    sheet.scene.cloths[0].appearance.weave = WeavePattern::solid;
    const auto drawn = [&](int samples, int supersample) {
        Renderer renderer(*context, sheet.scene,
                          {.width = 320, .height = 180, .samples = samples, .supersample = supersample});
        Image image;
        renderer.draw(DrawStyle::textured, sheet.frame, image);
        return image;
    };
    const Image finest = drawn(4, 4);
    const auto error = [&](const Image& image) {
        double sum = 0;
        for (std::size_t k = 0; k < image.pixels.size(); ++k)
            sum += std::pow(image.pixels[k] - finest.pixels[k], 2);
        return sum;
    };
    const double smooth = error(drawn(0, 1)), bare = error(drawn(1, 1)), samples = error(drawn(4, 1));
    INFO("squares off by " << smooth << "; one sample " << bare << ", four " << samples);
    CHECK(smooth < 0.5 * bare);
    CHECK(smooth < 1.5 * samples);
}

TEST_CASE("GL_a_picture_keeps_nothing_of_the_one_before") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(31);
    Renderer used(*context, sheet.scene, {.width = 640, .height = 360}),
        fresh(*context, sheet.scene, {.width = 640, .height = 360});
    DrawFrame close = sheet.frame;
    close.camera.fov = 12;  // fills the picture
    Image a, b;
    for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components, DrawStyle::overlay}) {
        used.draw(style, close, a);
        used.draw(style, sheet.frame, a);
        fresh.draw(style, sheet.frame, b);
        CHECK(a.pixels == b.pixels);
    }
}

TEST_CASE("GL_what_reaches_below_the_ground_is_hidden_by_it") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // A red ball whose middle lies on the ground: its lower half is not seen, in either view. A metre up, all
    // is.
    DrawScene scene = empty_scene({216, 222, 230});
    scene.components_background = {27, 30, 36};
    scene.show_ground = true;
    scene.solids.push_back(testing::ball(0.5f, {220, 20, 20}));
    DrawFrame frame;
    frame.camera = {.position = {0, 1, 5}, .target = {0, 0.5f, 0}, .up = {0, 1, 0}, .fov = 40};
    for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components}) {
        Renderer renderer(*context, scene, {.width = 160, .height = 160});
        std::array<int, 2> seen{};
        for (const float height : {0.f, 1.f}) {
            Image with, without;
            frame.solid_poses = {Eigen::Isometry3f::Identity()};
            frame.solid_poses[0].translation() = Vec3f(0, height, 0);
            renderer.draw(style, frame, with);
            frame.solid_poses[0].translation() = Vec3f(0, -5, 0);
            renderer.draw(style, frame, without);
            // By its red where it casts a shadow, which changes the ground as well.
            const auto differs = [&](int x, int y) {
                int most = 0;
                for (int c = 0; c < 3; ++c)
                    most = std::max(most, std::abs(with.at(x, y)[c] - without.at(x, y)[c]));
                return style == DrawStyle::textured ? with.at(x, y)[0] > 2 * with.at(x, y)[1] : most > 12;
            };
            for (int y = 0; y < 160; ++y) seen[height > 0] += differs(80, y);
        }
        INFO((style == DrawStyle::textured ? "textured" : "components")
             << ": pixels of the column through its middle: " << seen[0] << " half sunk, " << seen[1]
             << " above");
        CHECK(seen[1] > 20);
        CHECK(seen[0] > 0.4 * seen[1]);
        CHECK(seen[0] < 0.7 * seen[1]);
    }
}

TEST_CASE("GL_a_ridge_wears_the_light_of_the_side_that_is_seen") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // A roof whose ridge is seen nearly along one of its slopes. Its front is white and its back black; the
    // ridge's normals may point away from the viewer, but nothing black is seen.
    const int n = 121;
    DrawScene scene = empty_scene({128, 128, 128});
    ClothMesh mesh;
    mesh.appearance.weave = WeavePattern::solid;
    mesh.appearance.front = {240, 240, 240};
    mesh.appearance.back = {10, 10, 10};
    scene.spacing = 1.f / (n - 1);
    DrawFrame frame;
    for (int v = 0; v < n; ++v)
        for (int u = 0; u < n; ++u) {
            const float x = float(u) / (n - 1) - 0.5f, z = float(v) / (n - 1) - 0.5f;
            mesh.particle.push_back(v * n + u);
            mesh.uv.push_back({x + 0.5f, z + 0.5f});
            frame.positions.push_back({x, -0.9f * std::abs(z), z});
        }
    for (int v = 0; v + 1 < n; ++v)
        for (int u = 0; u + 1 < n; ++u) {
            const auto a = static_cast<std::uint32_t>(v * n + u), b = a + 1, c = a + n, d = c + 1;
            mesh.triangles.push_back({a, c, d});
            mesh.triangles.push_back({a, d, b});
        }
    scene.cloths.push_back(mesh);
    scene.bounds_low = {-0.5f, -0.5f, -0.5f};
    scene.bounds_high = {0.5f, 0.1f, 0.5f};
    scene.key_direction = {0, 1, 0.2f};
    frame.camera = {.position = {0, 0.3f, 3}, .target = {0, -0.2f, 0}, .up = {0, 1, 0}, .fov = 24};
    Renderer renderer(*context, scene, {.width = 320, .height = 180});
    Image image;
    renderer.draw(DrawStyle::textured, frame, image);
    int darkest = 255;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) darkest = std::min<int>(darkest, image.at(x, y)[1]);
    CHECK(darkest > 100);
}
