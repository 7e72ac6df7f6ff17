// Light, background and surfaces as a scene stages them.
#include <cmath>

#include "render/camera.hpp"
#include "render/color.hpp"
#include "render/renderer.hpp"
#include "render/sky_light.hpp"
#include "tests/render/ball.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/pictures.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;
using testing::empty_scene, testing::pixel;

namespace {

Image drawn(const GlContext& context, const DrawScene& scene, const DrawFrame& frame,
            Quality quality = Quality::standard) {
    Renderer renderer(context, scene, {.width = 160, .height = 120, .quality = quality, .passes = 16});
    Image image;
    renderer.draw(DrawStyle::textured, frame, image);
    return image;
}

Image plain_image(int width, int height, Rgb color) {
    Image image{width, height, {}};
    for (int k = 0; k < width * height; ++k)
        image.pixels.insert(image.pixels.end(), {color.r, color.g, color.b, 255});
    return image;
}

int off(Rgb a, Rgb b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

}  // namespace

TEST_CASE("light_of_a_sky_image_is_what_a_matt_surface_gathers_from_it") {
    // One half white, the other black: towards the middle of the white half all of it, along the border half.
    Image half = plain_image(64, 32, {0, 0, 0});
    for (int y = 0; y < 32; ++y)
        for (int x = 32; x < 64; ++x) std::fill_n(half.at(x, y), 3, std::uint8_t{255});
    const auto sky = sky_harmonics(half, 0.5f, {});
    // Nine harmonics hold a half sphere's light within 1%.
    CHECK(light_of(sky, {1, 0, 0}).x() == Approx(1).margin(0.02));
    CHECK(light_of(sky, {-1, 0, 0}).x() == Approx(0).margin(0.02));
    CHECK(light_of(sky, {0, 1, 0}).x() == Approx(0.5).margin(0.01));
    const float slant = std::sqrt(0.5f);  // (1 + cos 45°)/2 of it
    CHECK(light_of(sky, {slant, 0, -slant}).x() == Approx(0.5f + 0.5f * slant).margin(0.03));
    // What lies below the horizon is not the image's.
    const auto above = sky_harmonics(plain_image(8, 4, {40, 90, 200}), 0.4f, Vec3f(0.1f, 0.1f, 0.1f));
    const Vec3f down = light_of(above, {0, -1, 0}), up = light_of(above, {0, 1, 0});
    CHECK((down - Vec3f(0.1f, 0.1f, 0.1f)).norm() < 0.01);
    CHECK(up.dot(Vec3f(0.2126f, 0.7152f, 0.0722f)) == Approx(0.4f).margin(0.01));
    CHECK(up.z() > 3 * up.x());
}

TEST_CASE("GL_backgrounds_fill_the_picture_as_they_are") {
    const auto context = testing::open_renderer();
    if (!context) return;
    DrawScene scene = empty_scene({200, 100, 50});
    DrawFrame frame;
    frame.camera = {.position = {0, 0, 2}, .target = {0, 0, 0}, .fov = 40};
    for (const Quality quality : {Quality::draft, Quality::standard, Quality::final_}) {
        scene.background_top.reset();
        scene.background_image = {};
        scene.light = {};
        CHECK(off(pixel(drawn(*context, scene, frame, quality), 80, 60), {200, 100, 50}) <= 1);
        scene.background_top = Rgb{0, 40, 90};
        const Image gradient = drawn(*context, scene, frame, quality);
        CHECK(off(pixel(gradient, 3, 0), {0, 40, 90}) <= 3);
        CHECK(off(pixel(gradient, 150, 60), {100, 70, 70}) <= 3);
        CHECK(off(pixel(gradient, 80, 119), {200, 100, 50}) <= 3);
        // A square picture of a left and a right half: above and below are cut off.
        scene.background_image = plain_image(32, 32, {10, 20, 200});
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 16; ++x) scene.background_image.at(x, y)[0] = 220;
        const Image picture = drawn(*context, scene, frame, quality);
        CHECK(off(pixel(picture, 10, 5), {220, 20, 200}) <= 2);
        CHECK(off(pixel(picture, 150, 115), {10, 20, 200}) <= 2);
        // The sky: white above the horizon, dark below; the camera looks along it.
        scene.light.sky = plain_image(64, 32, {240, 240, 240});
        for (int y = 16; y < 32; ++y)
            for (int x = 0; x < 64; ++x) std::fill_n(scene.light.sky.at(x, y), 3, std::uint8_t{30});
        scene.light.show_sky = true;
        const Image sky = drawn(*context, scene, frame, quality);
        CHECK(off(pixel(sky, 80, 5), {240, 240, 240}) <= 2);
        CHECK(off(pixel(sky, 80, 115), {30, 30, 30}) <= 2);
    }
}

TEST_CASE("GL_a_ground_with_a_horizon_does_not_fade_away_before_it") {
    const auto context = testing::open_renderer();
    if (!context) return;
    DrawScene scene = empty_scene({255, 255, 255});
    scene.show_ground = true;
    scene.ground = {60, 60, 60};
    scene.bounds_low = {-0.5f, 0, -0.5f};
    scene.bounds_high = {0.5f, 1, 0.5f};
    DrawFrame frame;
    frame.camera = {.position = {0, 1, 3}, .target = {0, 1, 0}, .fov = 40};
    // The horizon is in the middle; a tenth of the picture below it the ground is 14 m away.
    const Image faded = drawn(*context, scene, frame);
    scene.horizon = true;
    const Image whole = drawn(*context, scene, frame);
    CHECK(pixel(faded, 80, 66).r > 240);
    CHECK(pixel(whole, 80, 66).r < 120);
    CHECK(off(pixel(whole, 80, 66), pixel(whole, 80, 110)) < 12);
    CHECK(pixel(whole, 80, 52).r == 255);
}

TEST_CASE("GL_exposure_and_strengths_scale_light") {
    const auto context = testing::open_renderer();
    if (!context) return;
    DrawScene scene = empty_scene({0, 0, 0});
    scene.solids.push_back(testing::ball(0.5f, {90, 90, 90}));
    scene.solids[0].finish = SurfaceFinish::matt;
    DrawFrame frame;
    frame.solid_poses.push_back(Eigen::Isometry3f::Identity());
    frame.camera = {.position = {0, 0, 3}, .target = {0, 0, 0}, .fov = 30};
    const auto light = [&] { return srgb_to_linear(drawn(*context, scene, frame).at(80, 60)[1] / 255.f); };
    const float usual = light();
    scene.light.exposure = 2;
    CHECK(light() == Approx(2 * usual).epsilon(0.03));
    scene.light.exposure = 1;
    scene.light.key_strength = 0;
    const float sky = light();
    scene.light.sky_strength = 0;
    CHECK(light() == Approx(0).margin(0.002));
    scene.light.key_strength = 1;
    CHECK(light() + sky == Approx(usual).epsilon(0.05));
}

TEST_CASE("GL_textures_lie_on_solids_and_ground_at_their_size") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // Halves of red and blue, 0.5 m in all: over a face of 1 m four bands.
    Image bands = plain_image(64, 64, {200, 20, 20});
    for (int y = 0; y < 64; ++y)
        for (int x = 32; x < 64; ++x) {
            bands.at(x, y)[0] = 20;
            bands.at(x, y)[2] = 200;
        }
    const auto changes = [](const Image& image, int row) {
        int count = 0;
        for (int x = 1; x < image.width; ++x) {
            const auto red = [&](int at) { return image.at(at, row)[0] > image.at(at, row)[2]; };
            const auto lit = [&](int at) { return image.at(at, row)[0] + image.at(at, row)[2] > 40; };
            count += lit(x) && lit(x - 1) && red(x) != red(x - 1) ? 1 : 0;
        }
        return count;
    };
    DrawScene scene = empty_scene({0, 0, 0});
    scene.solids.push_back(testing::box({1, 1, 0.2}, {}));
    scene.solids[0].texture = bands;
    scene.solids[0].texture_size = 0.5f;
    DrawFrame frame;
    frame.solid_poses.push_back(Eigen::Isometry3f::Identity());
    frame.camera = {.position = {0, 0, 3}, .target = {0, 0, 0}, .fov = 30};
    CHECK(changes(drawn(*context, scene, frame), 60) == 3);

    DrawScene ground = empty_scene({0, 0, 0});
    ground.show_ground = true;
    ground.ground_texture = bands;
    ground.ground_size = 0.5f;
    ground.bounds_low = {-3, 0, -3};
    ground.bounds_high = {3, 1, 3};
    DrawFrame above;
    above.camera = {.position = {0.01f, 2, 0}, .target = {0.01f, 0, 0}, .up = {0, 0, -1}, .fov = 30};
    // 2 · 2 · tan 15° · 4/3 = 1.43 m across: a border each 0.25 m.
    const int seen = changes(drawn(*context, ground, above), 60);
    CHECK(seen >= 5);
    CHECK(seen <= 6);
}

TEST_CASE("a_fitted_camera_holds_all_of_the_scene_and_its_shadow_and_no_more_than_that") {
    testing::Sheet sheet(5);
    DrawScene& scene = sheet.scene;
    for (const float aspect : {0.5f, 1.f, 16 / 9.f}) {
        for (const bool ground : {true, false}) {
            scene.show_ground = ground;
            const CameraView view =
                fitted({.position = {3, 2, 9}, .target = {1, 0, 1}, .fov = 40}, scene, aspect);
            CHECK((view.target - view.position).normalized().dot(Vec3f(-2, -2, -8).normalized()) > 0.99999f);
            const Projection camera = make_camera(view, aspect, scene.bounds_low, scene.bounds_high, 10);
            float farthest = 0;
            const Vec3f key = scene.key_direction.normalized();
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3f p(corner & 1 ? scene.bounds_high.x() : scene.bounds_low.x(),
                              corner & 2 ? scene.bounds_high.y() : scene.bounds_low.y(),
                              corner & 4 ? scene.bounds_high.z() : scene.bounds_low.z());
                for (const Vec3f& q : {p, ground ? Vec3f(p - key * (p.y() / key.y())) : p}) {
                    const Eigen::Vector4f clip = camera.projection * camera.view * q.homogeneous();
                    REQUIRE(clip.w() > 0);
                    farthest = std::max(farthest, (clip.head<2>() / clip.w()).cwiseAbs().maxCoeff());
                }
            }
            // It touches the rim, 6% within the picture.
            CHECK(farthest == Approx(0.94f).margin(1e-3));
        }
    }
}
