#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "render/color.hpp"
#include "render/palette.hpp"

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
                // Side by side, 0.02 can just be told apart; three times that is plain to see.
                CHECK((oklab(all[i], vision) - oklab(all[j], vision)).norm() > 0.06f);
            }
}
