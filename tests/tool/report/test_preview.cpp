#include "tool/report/preview.hpp"

#include <catch2/catch.hpp>

#include "tests/base/temporary_folder.hpp"
#include "tool/report/html.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

// As busy as a frame gets: thin bright lines of many colours on a dark ground.
Image busy_picture(int width, int height) {
    Image image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 4, 30)};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool line = (3 * x + y) % 22 < 2 || (x - 2 * y + 4 * height) % 26 < 2;
            if (!line || x < width / 4 || x > 3 * width / 4) continue;
            image.at(x, y)[0] = static_cast<std::uint8_t>(60 + (x * 7) % 190);
            image.at(x, y)[1] = static_cast<std::uint8_t>(60 + (y * 5) % 190);
        }
    }
    return image;
}

}  // namespace

TEST_CASE("base64 follows RFC 4648", "[report]") {
    CHECK(base64(bytes_of("")).empty());
    CHECK(base64(bytes_of("f")) == "Zg==");
    CHECK(base64(bytes_of("fo")) == "Zm8=");
    CHECK(base64(bytes_of("foobar")) == "Zm9vYmFy");
    CHECK(base64({0xff, 0xfe, 0xfd}) == "//79");
}

TEST_CASE("shrinking averages light, not code values", "[report]") {
    Image image{2, 2, std::vector<std::uint8_t>(16, 255)};
    for (int c = 0; c < 3; ++c) image.at(0, 0)[c] = image.at(1, 1)[c] = 0;
    const Image one = shrink(image, 1);
    REQUIRE(one.width == 1);
    // Half the light of white is 188 in sRGB; averaging code values would give 128.
    CHECK(one.at(0, 0)[0] == 188);
}

TEST_CASE("shrinking keeps the shape and never enlarges", "[report]") {
    const Image image = busy_picture(1280, 720);
    CHECK(shrink(image, 640).height == 360);
    CHECK(shrink(image, 5000).width == 1280);
}

TEST_CASE("600 frames of two busy views stay within the page's budget", "[report]") {
    constexpr std::size_t budget = std::size_t{24} << 20;
    const TemporaryFolder folder;
    Previews all(1280, 720, 1200, budget, folder.path());
    CHECK(all.width() >= 320);
    const Image image = busy_picture(1280, 720);
    // All of them are alike, so one tells what 1200 take.
    all.add("components", 0, image);
    CHECK(1200 * all.bytes() <= budget);
    // It is there again, and only there.
    CHECK(all.frames("components") == std::vector<int>{0});
    CHECK(all.frames("textured").empty());
    CHECK(all.text("components", 0).starts_with("UklGR"));
    CHECK(all.text("components", 0).size() == all.bytes());
}

TEST_CASE("values of a page may hold braces, and unknown names vanish", "[report]") {
    CHECK(fill_page("a {{x}} b {{y}} c", {{"x", "{{y}}"}, {"y", "2"}}) == "a {{y}} b 2 c");
    CHECK(fill_page("{{nothing}}!", {}) == "!");
    CHECK(fill_page("open {{", {}) == "open ");
    CHECK(html_text("a<b> & \"c\"") == "a&lt;b> &amp; &quot;c&quot;");
}
