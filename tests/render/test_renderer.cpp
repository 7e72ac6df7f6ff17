#include "render/renderer.hpp"

#include <epoxy/gl.h>

#include <cmath>
#include <fstream>
#include <string>

#include "render/color.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;

namespace {

DrawScene empty_scene(Rgb background) {
    DrawScene scene;
    scene.background = scene.components_background = background;
    scene.show_ground = false;
    return scene;
}

Rgb pixel(const Image& image, int x, int y) {
    const std::uint8_t* p = image.at(x, y);
    return {p[0], p[1], p[2]};
}

/// Two particles and a horizontal spring between them, seen from the front, `distance` away.
struct OneSpring {
    DrawScene scene = empty_scene({0, 0, 0});
    DrawFrame frame;

    OneSpring() {
        ClothMesh mesh;
        mesh.particle = {0, 1, 2};
        mesh.uv = {{0, 0}, {1, 0}, {0, 1}};
        mesh.triangles = {{0, 1, 2}};
        scene.edges = {{0, 1}};
        scene.spacing = 1;
        scene.cloths.push_back(mesh);
        // The triangle has no area: only the spring is seen.
        frame.positions = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
        frame.particle_colors.assign(3, {255, 255, 255});
        frame.camera = {.position = {0, 0, 4}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
    }
};

/// Width of the line across the column in the middle [px]: the sum of its coverage. The line is white on
/// black.
float measured_width(const Image& image, int x) {
    float width = 0;
    for (int y = 0; y < image.height; ++y) width += srgb_to_linear(pixel(image, x, y).g / 255.f);
    return width;
}

/// Resident memory of this process [kB].
long resident() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmRSS:") {
            long kilobytes = 0;
            status >> kilobytes;
            return kilobytes;
        }
    return 0;
}

}  // namespace

TEST_CASE("GL_grey_card_background_comes_back_as_its_own_bytes") {
    const auto context = testing::open_renderer();
    if (!context) return;
    Image image;
    for (const int supersample : {1, 2})
        for (int value = 0; value < 256; value += 15) {
            const Rgb grey{std::uint8_t(value), std::uint8_t(255 - value), std::uint8_t(value / 2)};
            const DrawScene scene = empty_scene(grey);
            Renderer renderer(*context, scene,
                              {.width = 16, .height = 16, .samples = 4, .supersample = supersample});
            for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components}) {
                renderer.draw(style, DrawFrame{}, image);
                REQUIRE(pixel(image, 3, 5) == grey);
                REQUIRE(image.at(3, 5)[3] == 255);
            }
        }
}

TEST_CASE("GL_half_covered_pixels_average_light_not_bytes") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // A white line of one pixel on black, drawn at twice the size: supersampled pixels at its rim are means
    // of white and black. Were bytes averaged, the coverage summed in light would come out far below the
    // line's width.
    const OneSpring spring;
    Image image;
    Renderer renderer(*context, spring.scene, {.width = 480, .height = 360, .samples = 1, .supersample = 2});
    renderer.draw(DrawStyle::components, spring.frame, image);
    CHECK(measured_width(image, 200) == Approx(1.0).epsilon(0.1));
}

TEST_CASE("GL_the_top_row_comes_first") {
    const auto context = testing::open_renderer();
    if (!context) return;
    DrawScene scene = empty_scene({0, 0, 0});
    scene.solids.push_back({.shape = SolidShape::sphere, .radius = 0.2f, .color = {255, 255, 255}});
    DrawFrame frame;
    frame.solid_poses.push_back(
        Eigen::Isometry3f(Eigen::Translation3f(0.4f, 0.8f, 0)));  // up and to the right
    frame.camera = {.position = {0, 0, 4}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
    Renderer renderer(*context, scene, {.width = 64, .height = 64, .samples = 4});
    Image image;
    for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components}) {
        renderer.draw(style, frame, image);
        std::array<int, 4> lit{};  // top left, top right, bottom left, bottom right
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                lit[(y >= 32 ? 2 : 0) + (x >= 32 ? 1 : 0)] += pixel(image, x, y).g > 20;
        CHECK(lit[1] > 50);
        CHECK(lit[0] + lit[2] + lit[3] == 0);
    }
}

TEST_CASE("GL_samples_beyond_the_renderers_limit_are_clamped_and_said") {
    const auto context = testing::open_renderer();
    if (!context) return;
    const DrawScene scene = empty_scene({10, 20, 30});
    const int limit = context->max_samples();
    const Renderer clamped(*context, scene, {.width = 16, .height = 16, .samples = 64});
    CHECK(clamped.description().find(std::to_string(limit) + " samples (64 asked") != std::string::npos);
    const Renderer given(*context, scene, {.width = 16, .height = 16, .samples = limit});
    CHECK(given.description().find("asked") == std::string::npos);
}

TEST_CASE("GL_a_picture_beyond_the_renderers_limit_is_refused_in_words") {
    const auto context = testing::open_renderer();
    if (!context) return;
    const DrawScene scene = empty_scene({10, 20, 30});
    CHECK_THROWS_WITH(Renderer(*context, scene, {.width = 1000000, .height = 16}),
                      Catch::Contains("smaller size"));
    CHECK_THROWS_AS(Renderer(*context, scene, {.width = 0, .height = 16}), RendererError);
}

TEST_CASE("GL_frames_that_do_not_fit_their_scene_are_refused") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(9);
    Renderer renderer(*context, sheet.scene, {.width = 32, .height = 32});
    Image image;
    DrawFrame frame = sheet.frame;
    frame.positions.pop_back();
    CHECK_THROWS_AS(renderer.draw(DrawStyle::textured, frame, image), std::invalid_argument);
    frame = sheet.frame;
    frame.edge_strength.assign(3, 255);
    CHECK_THROWS_AS(renderer.draw(DrawStyle::components, frame, image), std::invalid_argument);
    frame = sheet.frame;
    frame.particle_colors.clear();
    CHECK_THROWS_AS(renderer.draw(DrawStyle::components, frame, image), std::invalid_argument);
    CHECK_NOTHROW(renderer.draw(DrawStyle::textured, frame, image));
}

TEST_CASE("GL_wires_keep_their_share_of_the_pictures_height") {
    const auto context = testing::open_renderer();
    if (!context) return;
    const OneSpring spring;
    Image image;
    for (const int height : {360, 720, 1440}) {
        Renderer renderer(*context, spring.scene, {.width = height, .height = height, .samples = 4});
        renderer.draw(DrawStyle::components, spring.frame, image);
        INFO("height " << height);
        // 2 px at 720; a tenth is left for sampling of the line's soft rims.
        CHECK(measured_width(image, height * 2 / 5) == Approx(2.0 * height / 720).epsilon(0.1));
    }
}

TEST_CASE("GL_springs_of_no_strength_are_not_drawn_and_faint_ones_are_faint") {
    const auto context = testing::open_renderer();
    if (!context) return;
    OneSpring spring;
    Renderer renderer(*context, spring.scene, {.width = 360, .height = 360, .samples = 4});
    Image image;
    float width[3];
    for (int i = 0; i < 3; ++i) {
        spring.frame.edge_strength = {std::uint8_t(i == 0 ? 0 : i == 1 ? 80 : 255)};
        renderer.draw(DrawStyle::components, spring.frame, image);
        width[i] = measured_width(image, 144);
    }
    CHECK(width[0] == 0);
    CHECK(width[1] > 0.1f * width[2]);
    CHECK(width[1] < 0.5f * width[2]);
}

TEST_CASE("GL_the_same_frame_gives_the_same_bytes_however_it_is_asked_for") {
    const auto context = testing::open_renderer();
    if (!context) return;
    const testing::Sheet first(31), second(31, 1.f);
    Renderer renderer(*context, first.scene, {.width = 160, .height = 90});
    Image alone, again, piped[2];
    for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components}) {
        renderer.draw(style, first.frame, alone);
        renderer.submit(style, second.frame);
        renderer.submit(style, first.frame);
        CHECK(renderer.pending() == 2);
        renderer.collect(piped[0]);
        renderer.collect(piped[1]);
        CHECK(piped[1].pixels == alone.pixels);
        CHECK(piped[0].pixels != alone.pixels);
        Renderer fresh(*context, first.scene, {.width = 160, .height = 90});
        fresh.draw(style, first.frame, again);
        CHECK(again.pixels == alone.pixels);
    }
    CHECK_THROWS_AS(renderer.collect(again), std::invalid_argument);
}

TEST_CASE("GL_drawing_creates_nothing") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(41);
    Renderer renderer(*context, sheet.scene, {.width = 160, .height = 90});
    Image image;
    const auto draw_both = [&](int frame) {
        sheet.frame.camera.position.x() = 1.3f + 0.001f * static_cast<float>(frame);
        renderer.draw(DrawStyle::textured, sheet.frame, image);
        renderer.draw(DrawStyle::components, sheet.frame, image);
    };
    const auto live_objects = [] {
        int live = 0;
        for (GLuint name = 1; name < 4096; ++name)
            live += glIsBuffer(name) + glIsTexture(name) + glIsFramebuffer(name) + glIsRenderbuffer(name) +
                    glIsVertexArray(name) + glIsSampler(name) + glIsProgram(name) + glIsShader(name);
        return live;
    };
    for (int frame = 0; frame < 20; ++frame)
        draw_both(frame);  // drivers compile shader variants on first use
    const int objects = live_objects();
    CHECK(objects > 20);
    const long before = resident();
    for (int frame = 20; frame < 220; ++frame) draw_both(frame);
    CHECK(live_objects() == objects);
    // One leaked colour target of this size would be 57 kB a frame, 23 MB in all.
    CHECK(resident() - before < 4096);
    CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("GL_wires_wear_exactly_the_colour_they_are_given") {
    const auto context = testing::open_renderer();
    if (!context) return;
    OneSpring spring;
    const Rgb orange{230, 159, 0}, blue{0, 114, 178};
    spring.frame.particle_colors.assign(3, orange);
    Renderer renderer(*context, spring.scene, {.width = 720, .height = 720, .samples = 4});
    const auto brightest = [&] {
        Image image;
        renderer.draw(DrawStyle::components, spring.frame, image);
        Rgb best{0, 0, 0};
        for (int y = 0; y < image.height; ++y) {
            const Rgb c = pixel(image, 320, y);
            if (c.r + c.g + c.b > best.r + best.g + best.b) best = c;
        }
        return best;
    };
    const auto close = [](Rgb a, Rgb b) {
        return std::abs(a.r - b.r) <= 2 && std::abs(a.g - b.g) <= 2 && std::abs(a.b - b.b) <= 2;
    };
    CHECK(close(brightest(), orange));
    spring.frame.edge_colors.assign(1, blue);
    CHECK(close(brightest(), blue));
}

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
        CHECK(worst <= 1);
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
    scene.solids.push_back({.shape = SolidShape::sphere, .radius = 0.5f, .color = {255, 255, 255}});
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

TEST_CASE("GL_the_overlay_is_the_textured_view_with_wires_on_it") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(21);
    Renderer renderer(*context, sheet.scene, {.width = 320, .height = 180, .samples = 4});
    Image textured, overlay;
    renderer.draw(DrawStyle::textured, sheet.frame, textured);
    renderer.draw(DrawStyle::overlay, sheet.frame, overlay);
    CHECK(pixel(overlay, 2, 2) == pixel(textured, 2, 2));
    int changed = 0;
    for (int y = 0; y < 180; ++y)
        for (int x = 0; x < 320; ++x) changed += !(pixel(overlay, x, y) == pixel(textured, x, y));
    CHECK(changed > 1000);
    CHECK(changed < 20000);
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

TEST_CASE("GL_a_layer_that_has_grown_draws_what_a_fresh_one_draws") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(31);
    Renderer grown(*context, sheet.scene, {.width = 640, .height = 360}),
        fresh(*context, sheet.scene, {.width = 640, .height = 360});
    DrawFrame close = sheet.frame;
    close.camera.fov = 12;  // fills the picture
    Image a, b;
    for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components, DrawStyle::overlay}) {
        grown.draw(style, close, a);
        grown.draw(style, sheet.frame, a);
        fresh.draw(style, sheet.frame, b);
        CHECK(a.pixels == b.pixels);
    }
}

TEST_CASE("GL_a_ridge_wears_the_light_of_the_side_that_is_seen") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // A roof whose ridge is seen nearly along one of its slopes. Its front is white and its back black; the
    // ridge's normals may point away from the viewer, but nothing black is seen.
    const int n = 121;  // fine enough for light at vertices
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
