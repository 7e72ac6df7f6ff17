#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <random>

#include "render/color.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::render;

namespace {

using Edges = std::vector<std::array<std::uint32_t, 2>>;

Edges grid_edges(int n) {
    Edges edges;
    for (int v = 0; v < n; ++v)
        for (int u = 0; u < n; ++u) {
            const auto p = static_cast<std::uint32_t>(v * n + u);
            if (u + 1 < n) edges.push_back({p, p + 1});
            if (v + 1 < n) edges.push_back({p, p + n});
        }
    return edges;
}

/// Patches of a grid around random seeds: neighbouring regions of differing size.
std::vector<std::int32_t> patches(int n, int count, std::mt19937& random) {
    std::uniform_real_distribution<float> place(0, static_cast<float>(n));
    std::vector<Vec2f> seeds;
    for (int i = 0; i < count; ++i) seeds.emplace_back(place(random), place(random));
    std::vector<std::int32_t> component;
    for (int p = 0; p < n * n; ++p) {
        const Vec2f at(static_cast<float>(p % n), static_cast<float>(p / n));
        int best = 0;
        for (int i = 1; i < count; ++i)
            if ((seeds[i] - at).norm() < (seeds[best] - at).norm()) best = i;
        component.push_back(best);
    }
    return component;
}

/// OKLab coordinates of a colour as seen through a matrix on linear RGB. [Ottosson 2020]
Vec3f oklab(Rgb color, const Eigen::Matrix3f& vision) {
    const Vec3f rgb = (vision * linear(color)).cwiseMax(0);
    Eigen::Matrix3f to_lms, to_lab;
    to_lms << 0.4122215f, 0.5363325f, 0.0514460f, 0.2119035f, 0.6806995f, 0.1073970f, 0.0883025f, 0.2817188f,
        0.6299787f;
    to_lab << 0.2104543f, 0.7936178f, -0.0040720f, 1.9779985f, -2.4285922f, 0.4505937f, 0.0259040f,
        0.7827718f, -0.8086758f;
    return to_lab * (to_lms * rgb).array().pow(1 / 3.f).matrix();
}

}  // namespace

TEST_CASE("palette_largest_overlap_keeps_its_colour") {
    const Edges edges = grid_edges(10);
    ComponentColors colors;
    std::vector<std::int32_t> component(100, 0);
    const Rgb before = colors.assign(component, edges)[0];
    for (int p = 0; p < 30; ++p) component[p] = 7;  // three rows of ten split off
    const std::vector<Rgb>& after = colors.assign(component, edges);
    CHECK(after[99] == before);
    CHECK_FALSE(after[0] == before);
    // and the colours hold while nothing changes
    const std::vector<Rgb> held = after;
    CHECK(colors.assign(component, edges) == held);
}

TEST_CASE("palette_merged_components_take_the_larger_ones_colour") {
    const Edges edges = grid_edges(10);
    ComponentColors colors;
    std::vector<std::int32_t> component(100, 0);
    for (int p = 0; p < 30; ++p) component[p] = 1;
    const Rgb larger = colors.assign(component, edges)[99];
    std::fill(component.begin(), component.end(), 4);
    CHECK(colors.assign(component, edges)[0] == larger);
}

TEST_CASE("palette_neighbours_are_distinct") {
    std::mt19937 random(7);
    const int n = 40;
    const Edges edges = grid_edges(n);
    ComponentColors colors;
    for (int frame = 0; frame < 50; ++frame) {
        const std::vector<std::int32_t> component = patches(n, 5 + frame, random);
        const std::vector<Rgb>& color = colors.assign(component, edges);
        std::vector<int> size(component.size(), 0);
        for (const std::int32_t c : component) ++size[c];
        for (const auto& [a, b] : edges)
            if (component[a] != component[b] && size[component[a]] > 1 && size[component[b]] > 1)
                REQUIRE_FALSE(color[a] == color[b]);
    }
}

TEST_CASE("palette_does_not_depend_on_how_components_are_numbered") {
    std::mt19937 random(11);
    const int n = 30, count = 20;
    const Edges edges = grid_edges(n);
    ComponentColors plain, permuted;
    for (int frame = 0; frame < 20; ++frame) {
        std::vector<std::int32_t> component = patches(n, count, random), names(count);
        const std::vector<Rgb> expected = plain.assign(component, edges);
        for (int i = 0; i < count; ++i) names[i] = 3 * i + 1;
        std::shuffle(names.begin(), names.end(), random);
        for (std::int32_t& c : component) c = names[c];
        REQUIRE(permuted.assign(component, edges) == expected);
    }
}

TEST_CASE("palette_state_continues_where_it_was_left") {
    std::mt19937 random(13);
    const int n = 20;
    const Edges edges = grid_edges(n);
    ComponentColors whole, first;
    for (int frame = 0; frame < 10; ++frame) {
        const std::vector<std::int32_t> component = patches(n, 12, random);
        whole.assign(component, edges);
        first.assign(component, edges);
    }
    ComponentColors second;
    second.state = first.state;
    const std::vector<std::int32_t> component = patches(n, 12, random);
    CHECK(second.assign(component, edges) == whole.assign(component, edges));
}

TEST_CASE("palette_white_means_constrained_and_single_particles_are_calm") {
    const Edges edges = grid_edges(4);
    std::vector<std::int32_t> component(16);
    for (int p = 0; p < 16; ++p) component[p] = p;
    component[5] = -1;
    ComponentColors colors;
    const std::vector<Rgb> alone = colors.assign(component, edges);
    for (int p = 0; p < 16; ++p) CHECK(alone[p] == (p == 5 ? constrained_color : single_color));
    for (const Rgb& color : component_palette) CHECK_FALSE(color == constrained_color);
}

TEST_CASE("palette_a_component_that_lets_go_for_a_frame_comes_back_in_its_colour") {
    const Edges edges = grid_edges(10);
    ComponentColors colors;
    std::vector<std::int32_t> halves(100), singles(100);
    for (int p = 0; p < 100; ++p) {
        halves[p] = p / 50;
        singles[p] = p;
    }
    const std::vector<Rgb> before = colors.assign(halves, edges);
    colors.assign(singles, edges);
    CHECK(colors.assign(halves, edges) == before);
}

TEST_CASE("palette_colours_differ_for_the_colour_blind") {
    // Full protanopia, deuteranopia and tritanopia. [Machado, Oliveira & Fernandes 2009]
    std::array<Eigen::Matrix3f, 4> visions;
    visions[0].setIdentity();
    visions[1] << 0.152286f, 1.052583f, -0.204868f, 0.114503f, 0.786281f, 0.099216f, -0.003882f, -0.048116f,
        1.051998f;
    visions[2] << 0.367322f, 0.860646f, -0.227968f, 0.280085f, 0.672501f, 0.047413f, -0.011820f, 0.042940f,
        0.968881f;
    visions[3] << 1.255528f, -0.076749f, -0.178779f, -0.078411f, 0.930809f, 0.147602f, 0.004733f, 0.691367f,
        0.303900f;
    std::vector<Rgb> all(component_palette.begin(), component_palette.end());
    all.push_back(constrained_color);
    all.push_back(single_color);
    for (const Eigen::Matrix3f& vision : visions)
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t j = i + 1; j < all.size(); ++j) {
                INFO("colours " << i << " and " << j);
                // Side by side, 0.02 can just be told apart; four times that is plain to see.
                CHECK((oklab(all[i], vision) - oklab(all[j], vision)).norm() > 0.08f);
            }
    // Of all kinds of colour blindness deuteranopia is the most frequent.
    for (std::size_t i = 0; i < component_palette.size(); ++i)
        for (std::size_t j = i + 1; j < component_palette.size(); ++j)
            CHECK((oklab(all[i], visions[2]) - oklab(all[j], visions[2])).norm() > 0.12f);
}

TEST_CASE("palette_a_component_that_parts_again_wears_what_it_wore_before_it_merged") {
    const Edges edges = grid_edges(10);
    ComponentColors colors;
    std::vector<std::int32_t> apart(100), whole(100, 0), upper(100, 0);
    for (int p = 0; p < 100; ++p) apart[p] = p < 40 ? 1 : p < 80 ? 0 : 2;  // three bands
    for (int p = 80; p < 100; ++p) upper[p] = 1;                           // two of them merged
    const std::vector<Rgb> before = colors.assign(apart, edges);
    CHECK_FALSE(before[0] == before[50]);
    for (int frame = 0; frame < 20; ++frame) colors.assign(whole, edges);
    for (int frame = 0; frame < 5; ++frame) CHECK(colors.assign(upper, edges)[99] == before[99]);
    CHECK(colors.assign(apart, edges) == before);
}

TEST_CASE("palette_what_parts_for_the_first_time_is_told_apart_where_nothing_joins_it") {
    const Edges edges = grid_edges(10);
    ComponentColors colors;
    std::vector<std::int32_t> component(100, 0);
    colors.assign(component, edges);
    for (int p = 40; p < 60; ++p) component[p] = -1;  // held between two pieces
    for (int p = 60; p < 100; ++p) component[p] = 1;
    const std::vector<Rgb>& color = colors.assign(component, edges);
    CHECK_FALSE(color[0] == color[99]);
}

TEST_CASE("palette_new_neighbours_differ_in_lightness") {
    // Bands one after another: each has two neighbours at most, and there are colours of enough lightnesses.
    const int n = 24;
    const Edges edges = grid_edges(n);
    std::vector<std::int32_t> bands(n * n);
    for (int p = 0; p < n * n; ++p) bands[p] = p / (2 * n);
    ComponentColors colors;
    const std::vector<Rgb>& color = colors.assign(bands, edges);
    for (const auto& [a, b] : edges) {
        if (bands[a] == bands[b]) continue;
        const float one = oklab(color[a], Eigen::Matrix3f::Identity()).x(),
                    other = oklab(color[b], Eigen::Matrix3f::Identity()).x();
        CHECK(std::abs(one - other) > 0.1f);
    }
}

TEST_CASE("palette_colours_of_a_drape_hold_from_frame_to_frame") {
    // Components of the 51 × 51 particles of a drape on a sphere: a row for each of its frames at 30 a
    // second; red + 256 green is the component, from 1 on, or 0 where a particle is fully constrained.
    const Image record =
        read_png(std::filesystem::path(UNRAVEL_SOURCE_DIR) / "tests/render/drape_components.png");
    const Edges edges = grid_edges(51);
    ComponentColors colors;
    SteadyColors steady;
    std::vector<Rgb> raw_before, shown_before;
    long raw_changes = 0, shown_changes = 0, frames = 0;
    for (int frame = 0; frame < record.height; ++frame) {
        std::vector<std::int32_t> component;
        for (int p = 0; p < record.width; ++p)
            component.push_back(record.at(p, frame)[0] + 256 * record.at(p, frame)[1] - 1);
        const std::vector<Rgb> raw = colors.assign(component, edges), shown = steady.follow(raw);
        if (frame > 0) {
            ++frames;
            for (std::size_t p = 0; p < raw.size(); ++p) {
                raw_changes += !(raw[p] == raw_before[p]);
                shown_changes += !(shown[p] == shown_before[p]);
            }
        }
        raw_before = raw;
        shown_before = shown;
    }
    const double all = static_cast<double>(frames) * record.width;
    INFO("changes in " << 100 * raw_changes / all << "% of particle-frames, shown in "
                       << 100 * shown_changes / all);
    CHECK(shown_changes / all < 0.04);
    CHECK(raw_changes / all < 0.16);
}

TEST_CASE("palette_a_change_that_holds_is_shown_two_frames_late_and_others_are_not") {
    SteadyColors steady;
    const Rgb a{1, 0, 0}, b{2, 0, 0};
    CHECK(steady.follow({a, a}) == std::vector{a, a});
    CHECK(steady.follow({b, b}) == std::vector{a, a});
    CHECK(steady.follow({b, a}) == std::vector{a, a});
    CHECK(steady.follow({b, b}) == std::vector{b, a});
    CHECK(steady.follow({b, b}) == std::vector{b, a});
    CHECK(steady.follow({b, b}) == std::vector{b, b});
}
