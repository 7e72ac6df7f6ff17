// Light and shadow as properties of a picture.
#include <cmath>

#include "render/renderer.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/pictures.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;
using testing::empty_scene, testing::pixel;

namespace {

double mean_difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) sum += std::abs(a.pixels[k] - b.pixels[k]);
    return sum / (0.75 * static_cast<double>(a.pixels.size()));
}

Image drawn(const GlContext& context, const DrawScene& scene, const DrawFrame& frame,
            RenderSettings settings) {
    Renderer renderer(context, scene, settings);
    Image image;
    renderer.draw(DrawStyle::textured, frame, image);
    return image;
}

/// Adds a square sheet of n × n particles with sides of `size` around `middle`, its front towards +y.
void add_sheet(DrawScene& scene, DrawFrame& frame, int n, float size, const Vec3f& middle) {
    ClothMesh mesh;
    mesh.appearance.weave = WeavePattern::solid;
    mesh.appearance.front = mesh.appearance.back = {200, 200, 200};
    const auto first = static_cast<std::uint32_t>(frame.positions.size());
    const auto at = [n](int u, int v) { return static_cast<std::uint32_t>(v * n + u); };
    for (int v = 0; v < n; ++v)
        for (int u = 0; u < n; ++u) {
            const Vec2f uv(float(u) / float(n - 1), float(v) / float(n - 1));
            mesh.particle.push_back(first + at(u, v));
            mesh.uv.push_back(uv * size);
            frame.positions.push_back(middle + size * Vec3f(uv.x() - 0.5f, 0, uv.y() - 0.5f));
            if (u + 1 == n || v + 1 == n) continue;
            mesh.triangles.push_back({at(u, v), at(u, v + 1), at(u + 1, v)});
            mesh.triangles.push_back({at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)});
        }
    scene.cloths.push_back(std::move(mesh));
}

}  // namespace

TEST_CASE("GL_a_shadow_does_not_depend_on_texture_coordinates") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(61);
    sheet.scene.cloths[0].appearance.weave = WeavePattern::solid;
    const RenderSettings settings{.width = 320, .height = 180, .samples = 4};
    const Image right = drawn(*context, sheet.scene, sheet.frame, settings);

    DrawScene heap = sheet.scene;  // all at one place, below zero
    for (Vec2f& uv : heap.cloths[0].uv) uv = Vec2f(-0.7f, -0.7f);
    CHECK(mean_difference(right, drawn(*context, heap, sheet.frame, settings)) < 0.05);

    DrawScene islands = sheet.scene;  // one for each triangle
    ClothMesh& mesh = islands.cloths[0];
    const ClothMesh& whole = sheet.scene.cloths[0];
    mesh.particle.clear();
    mesh.uv.clear();
    for (std::array<std::uint32_t, 3>& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) {
            mesh.particle.push_back(whole.particle[corner]);
            corner = static_cast<std::uint32_t>(mesh.uv.size());
            mesh.uv.push_back({float(corner), corner % 3 == 0 ? 0.f : 1.f});
        }
    // The small maps of the sky are drawn by other triangles.
    CHECK(mean_difference(right, drawn(*context, islands, sheet.frame, settings)) < 0.5);
}

TEST_CASE("GL_shadow_and_ground_go_where_the_cloth_goes") {
    const auto context = testing::open_renderer();
    if (!context) return;
    testing::Sheet sheet(51);
    sheet.scene.cloths[0].appearance.weave = WeavePattern::solid;
    sheet.scene.bounds_low = {-3, 0, -3};  // wide enough for no fading ground in the picture
    sheet.scene.bounds_high = {3, 0.75f, 3};
    const RenderSettings settings{.width = 320, .height = 180, .samples = 4};
    const Image home = drawn(*context, sheet.scene, sheet.frame, settings);
    const Vec3f gone(7, 0, -3);
    DrawFrame frame = sheet.frame;
    for (Vec3f& x : frame.positions) x += gone;
    for (Eigen::Isometry3f& pose : frame.solid_poses) pose.translation() += gone;
    frame.camera.position += gone;
    frame.camera.target += gone;
    const Image away = drawn(*context, sheet.scene, frame, settings);
    // Below the cloth, where its shadow falls. Texels lie otherwise, so that edges differ.
    double sum = 0;
    for (int y = 130; y < 165; ++y)
        for (int x = 110; x < 260; ++x) sum += std::abs(home.at(x, y)[1] - away.at(x, y)[1]);
    INFO("mean difference " << sum / (35 * 150));
    int dark = 0;
    for (int x = 0; x < 320; ++x) dark += home.at(x, 145)[1] < 100;
    CHECK(dark > 30);
    CHECK(sum / (35 * 150) < 4);
}

TEST_CASE("GL_no_light_comes_through_a_cloth_close_above") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // The upper sheet shades all of the lower one that the camera sees, from ever nearer.
    for (const float gap : {0.05f, 0.02f, 0.01f, 0.006f}) {
        DrawScene scene = empty_scene({0, 0, 0});
        DrawFrame frame;
        scene.spacing = 0.02f;
        add_sheet(scene, frame, 51, 1, Vec3f(0, 0, 0));
        add_sheet(scene, frame, 51, 1.4f, Vec3f(0, gap, 0));
        scene.key_direction = {0.2f, 1, 0.1f};
        scene.bounds_low = {-0.7f, 0, -0.7f};
        scene.bounds_high = {0.7f, gap, 0.7f};
        frame.camera = {.position = {0, -2, 0.01f}, .target = {0, 0, 0}, .up = {0, 0, -1}, .fov = 20};
        // From below, light that came through would glow; against the same without a sheet above.
        const RenderSettings settings{.width = 160, .height = 160};
        const Image shaded = drawn(*context, scene, frame, settings);
        scene.cloths.pop_back();
        const Image open = drawn(*context, scene, frame, settings);
        int leaks = 0;
        for (int y = 30; y < 130; ++y)
            for (int x = 30; x < 130; ++x) leaks += shaded.at(x, y)[1] > open.at(x, y)[1] - 8;
        INFO("gap " << gap << ": " << leaks << " of 10000 pixels lit; " << int(shaded.at(80, 80)[1])
                    << " against " << int(open.at(80, 80)[1]));
        CHECK(leaks == 0);
    }
}

TEST_CASE("GL_the_edge_of_a_near_shadow_is_straight_where_its_caster_is") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // A sheet close above another, askew to pixels and to the map's texels, of two pixels each. Its shadow's
    // edge is found in each row as the place that divides its light, and lies on a line within half a pixel.
    DrawScene scene = empty_scene({0, 0, 0});
    DrawFrame frame;
    scene.spacing = 0.02f;
    add_sheet(scene, frame, 51, 1.2f, Vec3f(0, 0, 0));
    const std::size_t below = frame.positions.size();
    add_sheet(scene, frame, 31, 0.6f, Vec3f(0, 0.02f, 0));
    const Eigen::AngleAxisf askew(0.3f, Vec3f::UnitY());
    for (std::size_t p = below; p < frame.positions.size(); ++p)
        frame.positions[p] = askew * frame.positions[p];
    scene.key_direction = {0.9f, 1, 0};
    scene.bounds_low = {-0.6f, 0, -0.6f};
    scene.bounds_high = {0.6f, 0.02f, 0.6f};
    // Its middle is where the left side of the upper sheet casts its shadow.
    const Vec3f middle = askew * Vec3f(-0.3f, 0, 0) - Vec3f(0.018f, 0, 0);
    frame.camera = {
        .position = middle + Vec3f(0, 0.5f, 0.001f), .target = middle, .up = {0, 0, -1}, .fov = 10};
    const Image image = drawn(*context, scene, frame, {.width = 120, .height = 120});
    std::vector<double> edge;
    for (int y = 30; y < 90; ++y) {
        // From the lit side to the darkest.
        double bright = image.at(20, y)[1], dark = 255, sum = 0;
        int to = 20;
        for (int x = 20; x < 100; ++x)
            if (image.at(x, y)[1] < dark) dark = image.at(x, y)[1], to = x;
        for (int x = 20; x < to; ++x) sum += (image.at(x, y)[1] - dark) / (bright - dark);
        REQUIRE(bright - dark > 40);
        edge.push_back(20 + sum);
    }
    // Residuals of the least-squares line.
    const double n = static_cast<double>(edge.size());
    double mean = 0, slope = 0, squares = 0, off = 0;
    for (const double x : edge) mean += x / n;
    for (std::size_t k = 0; k < edge.size(); ++k) {
        const double row = static_cast<double>(k) - (n - 1) / 2;
        slope += row * edge[k];
        squares += row * row;
    }
    slope /= squares;
    for (std::size_t k = 0; k < edge.size(); ++k)
        off += std::pow(edge[k] - mean - slope * (static_cast<double>(k) - (n - 1) / 2), 2) / n;
    INFO("mean " << mean << ", slope " << slope << ", off by " << std::sqrt(off));
    CHECK(std::abs(slope) == Approx(std::tan(0.3)).epsilon(0.1));
    CHECK(std::sqrt(off) < 0.5);
}

TEST_CASE("GL_a_cloth_does_not_shade_itself_where_nothing_is_above") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // Gentle waves, lit at a slant: their light follows their slope, with no spots. Neighbours differ by no
    // more than the shading does, which changes over 10 cm, and the dither.
    DrawScene scene = empty_scene({0, 0, 0});
    DrawFrame frame;
    scene.spacing = 0.01f;
    add_sheet(scene, frame, 101, 1, Vec3f(0, 0, 0));
    for (Vec3f& x : frame.positions) x.y() = 0.01f * std::sin(12 * x.x()) * std::cos(9 * x.z());
    scene.key_direction = {0.6f, 1, 0.3f};
    scene.bounds_low = {-0.5f, -0.1f, -0.5f};
    scene.bounds_high = {0.5f, 0.1f, 0.5f};
    frame.camera = {.position = {0, 2, 0.4f}, .target = {0, 0, 0}, .up = {0, 0, -1}, .fov = 20};
    const Image image = drawn(*context, scene, frame, {.width = 320, .height = 320});
    int most = 0;
    for (int y = 40; y < 280; ++y)
        for (int x = 40; x < 280; ++x)
            most = std::max({most, std::abs(image.at(x, y)[1] - image.at(x + 1, y)[1]),
                             std::abs(image.at(x, y)[1] - image.at(x, y + 1)[1])});
    CHECK(most <= 5);
}

TEST_CASE("GL_a_supersampled_weave_is_the_fine_one_and_has_no_moire") {
    const auto context = testing::open_renderer();
    if (!context) return;
    for (const WeavePattern weave : {WeavePattern::twill, WeavePattern::checks, WeavePattern::stripes}) {
        testing::Sheet sheet(51);
        sheet.scene.cloths[0].appearance.weave = weave;
        sheet.scene.cloths[0].appearance.period = 0.02f;
        const RenderSettings plain{.width = 320, .height = 180, .samples = 4},
            super{.width = 320, .height = 180, .samples = 1, .supersample = 3};
        const double off = mean_difference(drawn(*context, sheet.scene, sheet.frame, plain),
                                           drawn(*context, sheet.scene, sheet.frame, super));
        INFO("weave " << int(weave) << ": " << off);
        // Outlines and shadows' edges are sampled otherwise: a few pixels of a hundred by tens.
        CHECK(off < 1.2);
    }
}

TEST_CASE("GL_a_picture_lies_on_its_cloth_by_its_texture_coordinates") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // Quarters red, green over blue, grey. Seen from above with u to the right and v up.
    Image quarters{64, 64, std::vector<std::uint8_t>(64 * 64 * 4, 255)};
    const Rgb colors[2][2]{{{220, 30, 30}, {30, 200, 30}}, {{30, 30, 220}, {90, 90, 90}}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Rgb c = colors[y / 32][x / 32];
            std::uint8_t* p = quarters.at(x, y);
            p[0] = c.r, p[1] = c.g, p[2] = c.b;
        }
    const auto hue = [](Rgb c) {  // 0 red, 1 green, 2 blue, 3 grey
        if (std::max({c.r, c.g, c.b}) < 1.6 * std::min({c.r, c.g, c.b})) return 3;
        return c.r > c.g && c.r > c.b ? 0 : c.g > c.b ? 1 : 2;
    };
    // vt = from + share × (x, y) of the sheet, both in [0, 1].
    const auto look = [&](float from, float share) {
        DrawScene scene = empty_scene({0, 0, 0});
        DrawFrame frame;
        add_sheet(scene, frame, 21, 1, Vec3f(0, 0, 0));
        ClothMesh& mesh = scene.cloths[0];
        for (Vec2f& uv : mesh.uv)
            uv = Vec2f(from + share * uv.x(), from + share * (1 - uv.y()));  // z is down
        mesh.picture_scale = {1, 1};
        mesh.texture = quarters;
        scene.bounds_low = {-0.5f, -0.1f, -0.5f};
        scene.bounds_high = {0.5f, 0.1f, 0.5f};
        frame.camera = {
            .position = {0, 3, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}, .fov = 18.92f};  // ±0.5 m
        return drawn(*context, scene, frame, {.width = 120, .height = 120});
    };
    const auto at = [&](const Image& image, double x, double y) {
        return hue(pixel(image, static_cast<int>(x * 120), static_cast<int>((1 - y) * 120)));
    };
    const auto corners = [&](const Image& image) {
        return std::array{at(image, 0.1, 0.9), at(image, 0.9, 0.9), at(image, 0.1, 0.1), at(image, 0.9, 0.1)};
    };
    CHECK(corners(look(0, 1)) == std::array{0, 1, 2, 3});
    CHECK(corners(look(-1, 1)) == std::array{0, 1, 2, 3});
    CHECK(corners(look(0, 0.5f)) == std::array{2, 2, 2, 2});      // its lower left quarter
    CHECK(corners(look(0.25f, 0.5f)) == std::array{0, 1, 2, 3});  // its middle
    const Image nine = look(0, 3);
    for (const double x : {0., 1 / 3., 2 / 3.})
        for (const double y : {0., 1 / 3., 2 / 3.}) {
            CHECK(at(nine, x + 0.08, y + 0.25) == 0);
            CHECK(at(nine, x + 0.25, y + 0.08) == 3);
        }
}

TEST_CASE("GL_slow_gradients_show_no_bands") {
    const auto context = testing::open_renderer();
    if (!context) return;
    // The bare ground fades into the background: a step of one in 255 is spread over all that it takes, so
    // that no two rows in a hundred have the same mean but for the ends.
    DrawScene scene = empty_scene({216, 222, 230});
    scene.show_ground = true;
    DrawFrame frame;
    frame.camera = {.position = {0, 1, 3}, .target = {0, 0.3f, 0}, .up = {0, 1, 0}, .fov = 40};
    const Image image = drawn(*context, scene, frame, {.width = 320, .height = 720});
    int same = 0, rows = 0;
    for (int y = 200; y < 700; ++y) {
        const auto mean = [&](int row) {
            double sum = 0;
            for (int x = 150; x < 170; ++x) sum += image.at(x, row)[1];
            return sum / 20;
        };
        const double away = std::abs(mean(y) - mean(y - 20));
        if (away < 0.5 || away > 12) continue;  // flat, or not slow
        ++rows;
        bool flat = true;
        for (int row = y - 7; row <= y; ++row)
            for (int x = 150; x < 170; ++x) flat = flat && image.at(x, row)[1] == image.at(150, y)[1];
        same += flat;
    }
    INFO(same << " of " << rows << " rows are as one with the seven before");
    CHECK(rows > 50);
    CHECK(same == 0);
}

TEST_CASE("GL_flat_faces_of_a_mesh_are_flat_and_round_ones_round") {
    const auto context = testing::open_renderer();
    if (!context) return;
    SolidMesh cube{.half_extents = Vec3f::Constant(0.4f), .color = {180, 180, 180}};
    for (int k = 0; k < 8; ++k)
        cube.positions.push_back(0.4f * Vec3f(k & 1 ? 1.f : -1.f, k & 2 ? 1.f : -1.f, k & 4 ? 1.f : -1.f));
    cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    DrawScene scene = empty_scene({0, 0, 0});
    scene.solids.push_back(cube);
    scene.bounds_low = Vec3f::Constant(-0.4f);
    scene.bounds_high = Vec3f::Constant(0.4f);
    DrawFrame frame;
    frame.solid_poses.push_back(Eigen::Isometry3f::Identity());
    frame.camera = {.position = {0, 0, 3}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 30};
    const Image image = drawn(*context, scene, frame, {.width = 120, .height = 120});
    int low = 255, high = 0;
    for (int y = 32; y < 88; ++y)
        for (int x = 32; x < 88; ++x) {
            low = std::min<int>(low, image.at(x, y)[1]);
            high = std::max<int>(high, image.at(x, y)[1]);
        }
    CHECK(high - low <= 8);  // the sky's light, which is told at corners
}
