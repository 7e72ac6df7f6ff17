// The surface of grids, tubes and meshes; the search for near features and the count of crossings against all
// features tried with all others.

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "sim/surface/closest.hpp"
#include "sim/surface/crossings.hpp"
#include "sim/surface/feature_pairs.hpp"
#include "tests/sim/surface/random_surface.hpp"

using namespace unravel::sim;
using namespace unravel::testing;

namespace {

std::vector<Box> boxes_around(const std::vector<Vec3>& x, double reach) {
    std::vector<Box> boxes;
    for (const Vec3& p : x) boxes.push_back({p - Vec3::Constant(reach), p + Vec3::Constant(reach)});
    return boxes;
}

// All pairs that are nearer than `near` as they stand.
std::set<std::array<std::uint32_t, 2>> near_pairs(const PlacedSurface& placed, FeaturePair kind,
                                                  double near) {
    const bool vertices = kind == FeaturePair::vertex_triangle;
    const std::size_t first = vertices ? placed.x.size() : placed.surface.edges.size(),
                      second = vertices ? placed.surface.triangles.size() : placed.surface.edges.size();
    std::set<std::array<std::uint32_t, 2>> out;
    for (std::uint32_t i = 0; i < first; ++i) {
        for (std::uint32_t j = vertices ? 0 : i + 1; j < second; ++j) {
            const std::array<std::uint32_t, 4> corners = corners_of(placed.surface, kind, {i, j});
            if (std::set<std::uint32_t>(corners.begin(), corners.end()).size() < 4) continue;
            std::array<Vec3, 4> x;
            for (std::size_t k = 0; k < 4; ++k) x[k] = placed.x[corners[k]];
            if (combined(weights_of(kind, x), x).norm() <= near) out.insert({i, j});
        }
    }
    return out;
}

std::vector<Crossing> brute_crossings(const PlacedSurface& placed) {
    std::vector<Crossing> out;
    for (std::uint32_t e = 0; e < placed.surface.edges.size(); ++e) {
        for (std::uint32_t t = 0; t < placed.surface.triangles.size(); ++t) {
            const auto& [p, q] = placed.surface.edges[e];
            const auto& [a, b, c] = placed.surface.triangles[t];
            if (std::set<std::uint32_t>{p, q, a, b, c}.size() < 5) continue;
            const auto& x = placed.x;
            if (passes_through({p, q, a, b, c}, {x[p], x[q], x[a], x[b], x[c]})) out.push_back({e, t});
        }
    }
    return out;
}

}  // namespace

TEST_CASE("a grid's surface has every triangle, edge and vertex once", "[surface]") {
    SurfaceBuilder builder;
    builder.add_grid(0, 5, 4, false);
    builder.add_grid(20, 6, 3, true);
    builder.add_grid(38, 1, 4, false);
    const Surface surface = builder.build();
    CHECK(surface.triangles.size() == 2 * 4 * 3 + 2 * 6 * 2);
    // Euler's formula: vertices − edges + faces is 1 of a sheet and 0 of a tube; a ribbon has three edges.
    CHECK(surface.edges.size() == (20 + 24 - 1) + (18 + 24 - 0) + 3);
    CHECK(surface.vertices.size() == 42);
    CHECK(surface.cloth[19] == 0);
    CHECK(surface.cloth[20] == 1);
    CHECK(surface.cloth[41] == 2);
    std::size_t borders = 0, loose = 0;
    for (const auto& [one, other] : surface.sides) {
        loose += one == Surface::none;
        borders += one != Surface::none && other == Surface::none;
    }
    CHECK(loose == 3);
    CHECK(borders == 2 * (4 + 3) + 2 * 6);
}

TEST_CASE("every feature belongs to one leaf of the tree", "[surface]") {
    PlacedSurface placed = crumpled_sheets(3, 14, 0.1, 0.01, 3);
    const SurfaceTree tree(placed.surface, placed.x);
    const auto each_once = [](std::vector<std::uint32_t> list, std::size_t count) {
        std::sort(list.begin(), list.end());
        if (list.size() != count) return false;
        for (std::uint32_t k = 0; k < count; ++k) {
            if (list[k] != k) return false;
        }
        return true;
    };
    CHECK(each_once(tree.triangles.list, placed.surface.triangles.size()));
    CHECK(each_once(tree.edges.list, placed.surface.edges.size()));
    CHECK(each_once(tree.vertices.list, placed.x.size()));
}

TEST_CASE("the search misses no near pair and finds none twice", "[surface]") {
    const double reach = 0.06;
    for (const PlacedSurface& placed : {soup(150, 0.2, 4), crumpled_sheets(2, 9, 0.08, 0.03, 5)}) {
        SurfaceTree tree(placed.surface, placed.x);
        tree.refit(placed.surface, boxes_around(placed.x, 0.5 * reach));
        FeaturePairs pairs;
        find_pairs(placed.surface, tree, pairs);
        for (const FeaturePair kind : {FeaturePair::vertex_triangle, FeaturePair::edge_edge}) {
            const PairList& list =
                kind == FeaturePair::vertex_triangle ? pairs.vertex_triangle : pairs.edge_edge;
            const std::set<std::array<std::uint32_t, 2>> found(list.begin(), list.end());
            CHECK(found.size() == list.size());
            const auto near = near_pairs(placed, kind, reach);
            CHECK(near.size() > 50);
            CHECK(std::includes(found.begin(), found.end(), near.begin(), near.end()));
        }
    }
}

TEST_CASE("crossings are those that trying every edge with every triangle finds", "[surface]") {
    for (const PlacedSurface& placed : {soup(200, 0.2, 6), crumpled_sheets(2, 12, 0.02, 0.03, 7)}) {
        SurfaceTree tree(placed.surface, placed.x);
        const std::vector<Crossing> found = find_crossings(placed.surface, placed.x, tree);
        CHECK(found.size() > 20);
        CHECK(found == brute_crossings(placed));
    }
}

TEST_CASE("crossings of two sheets are as many as geometry says", "[surface]") {
    // A level sheet of 10 × 10 cells, and one upright through its middle, 1 mm off the grid's lines or
    // exactly on one of them: each of its 11 upright threads passes once, and so does every diagonal between.
    for (const double off : {0.013, 0.0}) {
        SurfaceBuilder builder;
        builder.add_grid(0, 11, 11, false);
        builder.add_grid(121, 11, 11, false);
        PlacedSurface placed{builder.build(), {}};
        for (int j = 0; j < 11; ++j) {
            for (int i = 0; i < 11; ++i) placed.x.push_back({0.1 * i, 0, 0.1 * j});
        }
        for (int j = 0; j < 11; ++j) {
            for (int i = 0; i < 11; ++i) placed.x.push_back({0.1 * i, 0.1 * j - 0.53, 0.5 + off});
        }
        SurfaceTree tree(placed.surface, placed.x);
        std::vector<Crossing> through_level;
        for (const Crossing& c : find_crossings(placed.surface, placed.x, tree)) {
            if (placed.surface.triangles[c.triangle][0] < 121) through_level.push_back(c);
        }
        // Ends of the upright sheet lie in the level one's border, where a touch may count either way.
        CHECK(through_level.size() >= 9 + 10);
        CHECK(through_level.size() <= 11 + 10);
        for (const Crossing& c : through_level)
            CHECK(std::abs(place_of(placed.surface, placed.x, c).y()) < 1e-12);
    }
}
