// Springs as wires: width, strength, colour, and over the textured view.
#include "render/color.hpp"
#include "render/renderer.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/pictures.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;
using testing::empty_scene, testing::pixel;

namespace {

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

}  // namespace

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
