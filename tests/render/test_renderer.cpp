#include "render/renderer.hpp"

#include <epoxy/gl.h>

#include <fstream>
#include <string>

#include "tests/allocations.hpp"
#include "tests/render/ball.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/pictures.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;
using testing::empty_scene, testing::pixel;

namespace {

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

TEST_CASE("GL_the_top_row_comes_first") {
    const auto context = testing::open_renderer();
    if (!context) return;
    DrawScene scene = empty_scene({0, 0, 0});
    scene.solids.push_back(testing::ball(0.2f, {255, 255, 255}));
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
    const Renderer clamped(*context, scene, {.width = 16, .height = 16, .samples = 2 * limit});
    const std::string said = std::to_string(limit) + " samples (" + std::to_string(2 * limit) + " asked";
    CHECK(clamped.description().find(said) != std::string::npos);
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
    for (int frame = 0; frame < 100; ++frame)
        draw_both(frame);  // drivers compile shader variants on first use, and fill their own pools
    const int objects = live_objects();
    CHECK(objects > 20);
    [[maybe_unused]] const long before = resident();
    for (int frame = 100; frame < 300; ++frame) draw_both(frame);
    CHECK(live_objects() == objects);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they keep what was freed for a while
    // One leaked colour target of this size would be 57 kB a picture, 23 MB in all.
    CHECK(resident() - before < 8192);
#endif
    CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("GL_drawing_allocates_nothing") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(41);
    Renderer renderer(*context, sheet.scene, {.width = 160, .height = 90});
    Image image;
    const auto draw_all = [&] {
        sheet.frame.camera.position.x() += 0.001f;
        for (const DrawStyle style : {DrawStyle::textured, DrawStyle::components, DrawStyle::overlay})
            renderer.draw(style, sheet.frame, image);
    };
    for (int frame = 0; frame < 5; ++frame) draw_all();  // drivers compile shader variants on first use
    const testing::AllocationCount count;
    for (int frame = 0; frame < 100; ++frame) draw_all();
    CHECK(count.so_far() == 0);
}
