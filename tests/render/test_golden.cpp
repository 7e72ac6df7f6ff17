// Frames against stored ones. tests/golden was drawn by llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6. Its
// pixels do not depend on its thread count, but the processor's own approximations of reciprocals and square
// roots enter them: the same Mesa on another maker's processor was seen to move 281 of 57,600 pixels by one
// step of 255. UNRAVEL_WRITE_GOLDEN=1 draws them anew.
#include <cstdlib>
#include <filesystem>

#include "render/png.hpp"
#include "render/renderer.hpp"
#include "source_dir.hpp"
#include "tests/render/gl_test.hpp"
#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;

namespace {

struct Difference {
    int most = 0;      ///< of one channel of one pixel
    double mean = 0;   ///< over all channels
    int x = 0, y = 0;  ///< where it is greatest
};

Difference compare(const Image& a, const Image& b) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    Difference difference;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const int d = std::abs(a.at(x, y)[c] - b.at(x, y)[c]);
                difference.mean += d;
                if (d > difference.most) {
                    difference.most = d;
                    difference.x = x;
                    difference.y = y;
                }
            }
    difference.mean /= 3.0 * a.width * a.height;
    return difference;
}

void check_golden(const char* name, DrawStyle style, int samples) {
    const auto context = testing::open_renderer();
    if (!context) return;
    const testing::Sheet sheet(51);
    Renderer renderer(*context, sheet.scene, {.width = 320, .height = 180, .samples = samples});
    Image image;
    renderer.draw(style, sheet.frame, image);
    const std::filesystem::path file = std::filesystem::path(UNRAVEL_SOURCE_DIR) / "tests/golden" / name;
    if (std::getenv("UNRAVEL_WRITE_GOLDEN")) write_png(file, image, {.level = 9});
    const Difference difference = compare(image, read_png(file));
    // What was drawn stays to be looked at, whichever of the checks below it fails.
    const std::filesystem::path drawn =
        std::filesystem::path(UNRAVEL_SOURCE_DIR) / "build/golden_differs" / name;
    if (difference.most > 0) {
        std::filesystem::create_directories(drawn.parent_path());
        write_png(drawn, image);
    }
    INFO("greatest difference " << difference.most << " at " << difference.x << ", " << difference.y
                                << " with " << context->renderer() << ", " << context->version() << "; see "
                                << drawn);
    if (context->version().find("Mesa 22.3.6") != std::string::npos &&
        context->renderer().find("llvmpipe (LLVM 15.0.6, 256 bits)") != std::string::npos) {
        CHECK(difference.most <= 2);
        CHECK(difference.mean <= 0.02);
    } else {
        // Elsewhere samples and rounding may move single pixels of an outline, but not the picture.
        CHECK(difference.most <= 128);
        CHECK(difference.mean <= 1.5);
    }
}

}  // namespace

TEST_CASE("GL_textured_frame_matches_golden") {
    check_golden("textured.png", DrawStyle::textured, 4);
}

TEST_CASE("GL_components_frame_matches_golden") {
    check_golden("components.png", DrawStyle::components, 4);
}

// Drawn by llvmpipe; a GPU's default is four samples, which is within the thresholds.
TEST_CASE("GL_textured_frame_with_smooth_outlines_matches_golden") {
    check_golden("outlines.png", DrawStyle::textured, 0);
}
