#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <string>

#include "tool/plot/plot.hpp"
#include "tool/plot/ticks.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

Plot simple_plot() {
    Plot plot;
    plot.x.label = "time [s]";
    plot.y.label = "error";
    plot.series.push_back({"a", {{1, 1e-3}, {2, 1e-4}, {3, 1e-5}}});
    return plot;
}

// Pixels that are neither grey, white nor black: the series' own ink.
int colored_pixels(const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* p = image.at(x, y);
            count += std::abs(p[0] - p[2]) > 60;
        }
    }
    return count;
}

}  // namespace

TEST_CASE("linear ticks lie within the axis, evenly, and are few") {
    for (const auto& [from, to] : {std::pair{0.0, 1.0}, {-3.0, 17.0}, {0.1, 0.100001}, {-1e6, 1e6}}) {
        const std::vector<Tick> ticks = linear_ticks(from, to, 6);
        CAPTURE(from, to);
        REQUIRE(ticks.size() >= 2);
        CHECK(ticks.size() <= 14);
        for (std::size_t k = 0; k < ticks.size(); ++k) {
            CHECK(ticks[k].value >= from - 1e-6 * (to - from));
            CHECK(ticks[k].value <= to + 1e-6 * (to - from));
            // A billionth of the value: what doubles of that size resolve.
            if (k > 0)
                CHECK(ticks[k].value - ticks[k - 1].value ==
                      Approx(ticks[1].value - ticks[0].value).epsilon(1e-4));
        }
    }
}

TEST_CASE("log ticks name every decade of a short axis and some of a long one") {
    const std::vector<Tick> few = log_ticks(0.5, 200);
    std::string names;
    for (const Tick& tick : few) names += tick.label.empty() ? "" : tick.label + " ";
    CHECK(names == "1 10 100 ");
    int labelled = 0;
    for (const Tick& tick : log_ticks(1e-20, 1e20)) labelled += !tick.label.empty();
    CHECK(labelled >= 4);
    CHECK(labelled <= 12);
    CHECK(power_of_ten(-12) == "10⁻¹²");
}

TEST_CASE("a plot has the size asked for and shows its series") {
    const Plot plot = simple_plot();
    const Image image = plot_image(plot, 1);
    CHECK(image.width == plot.width);
    CHECK(image.height == plot.height);
    Plot empty = plot;
    empty.series.clear();
    CHECK(colored_pixels(plot_image(empty, 1)) == 0);
    CHECK(colored_pixels(image) > 100);
}

TEST_CASE("a point that is not finite is drawn at the upper edge") {
    Plot plot = simple_plot();
    plot.series[0].points = {{1, 1}, {2, 2}, {3, INFINITY}};
    plot.series[0].style = SeriesStyle::points;
    plot.series[0].label.clear();
    Plot without = plot;
    without.series[0].points.pop_back();
    without.x.from = plot.x.from = 0;
    without.x.to = plot.x.to = 4;
    CHECK(colored_pixels(plot_image(plot, 1)) > colored_pixels(plot_image(without, 1)));
}

// Letters written twice over each other can be read no more.
TEST_CASE("notes of points that lie together give way to each other") {
    Plot plot = simple_plot();
    plot.series[0].points = {{1, 1}, {2, 2}, {3, 3}};
    const auto ink = [&](const char* first, const char* second) {
        plot.series[0].points[1].note = first;
        plot.series.resize(1);
        plot.series.push_back(plot.series[0]);
        plot.series[1].points[1].note = second;
        const Image image = plot_image(plot, 1);
        std::size_t dark = 0;
        for (std::size_t k = 0; k < image.pixels.size(); k += 4) dark += image.pixels[k] < 100;
        return dark;
    };
    const std::size_t none = ink("", ""), one = ink("1/400 s", ""), both = ink("1/400 s", "1/400 s");
    CHECK(one > none);
    CHECK(both - none == Approx(2.0 * static_cast<double>(one - none)).epsilon(0.15));
}

TEST_CASE("values a log axis can't hold are left out") {
    Plot plot = simple_plot();
    plot.y.log = true;
    plot.series[0].points.push_back({4, 0});
    plot.series[0].points.push_back({5, -1});
    CHECK(plot_svg(plot).find("nan") == std::string::npos);
    plot.series[0].points.clear();
    CHECK(plot_svg(plot).find("nan") == std::string::npos);
}

// A page holds several documents, and a name in it is to mean one thing.
TEST_CASE("names within SVG documents of two plots differ") {
    const auto names = [](const std::string& svg, const std::string& before) {
        std::set<std::string> found;
        for (std::size_t at = svg.find(before); at != svg.npos; at = svg.find(before, at + 1))
            found.insert(svg.substr(at + before.size(),
                                    svg.find_first_of("\")", at + before.size()) - at - before.size()));
        return found;
    };
    Plot other = simple_plot();
    other.title = "another";
    const std::string a = plot_svg(simple_plot()), b = plot_svg(other);
    const std::set<std::string> ours = names(a, "id=\""), theirs = names(b, "id=\"");
    REQUIRE(ours.size() > 5);
    for (const std::string& name : ours) CHECK(theirs.count(name) == 0);
    for (const std::string& name : names(a, "href=\"#")) CHECK(ours.count(name) == 1);
    for (const std::string& name : names(a, "url(#")) CHECK(ours.count(name) == 1);
}

TEST_CASE("a plot is a whole SVG document") {
    const std::string svg = plot_svg(simple_plot());
    CHECK(svg.find("<svg") != std::string::npos);
    CHECK(svg.find("</svg>") != std::string::npos);
}
