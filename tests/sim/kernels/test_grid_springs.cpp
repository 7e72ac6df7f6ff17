// Where a grid cloth's springs are, by stencil, against the lists that say it by index.

#include <catch2/catch.hpp>

#include "sim/terms/grid_tables.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

Cloth cloth_of(const char* name, int nu, int nv, bool tube) {
    Cloth cloth = sheet(2, 1.0);
    cloth.name = name;
    cloth.particles = {nu, nv};
    cloth.wrap = tube ? Wrap::tube : Wrap::open;
    cloth.material.bend = 1e-5;
    return cloth;
}

Scene scene_of_all_shapes() {
    Scene scene;
    scene.cloths = {cloth_of("open", 6, 4, false),   cloth_of("tube", 7, 3, true),
                    cloth_of("ribbon", 1, 9, false), cloth_of("row", 5, 1, false),
                    cloth_of("ring", 3, 2, true),    cloth_of("point", 1, 1, false)};
    return scene;
}

// Springs of `rows` that the lists place elsewhere.
template <typename Springs>
int misplaced(const GridSprings& grid, const SpringRows& rows, const Springs& springs) {
    int wrong = 0;
    for (std::uint32_t j = 0; j < rows.rows; ++j) {
        for (std::uint32_t i = 0; i < rows.per_row; ++i) {
            const std::uint32_t p = grid.at(i + rows.from[0], j + rows.from[1]);
            const std::uint32_t q = grid.at(i + rows.to[0], j + rows.to[1]);
            const std::uint32_t s = rows.at(i, j);
            wrong += springs.i[s] != std::min(p, q) || springs.j[s] != std::max(p, q);
            // Only along u, and only where the ring closes, are the ends swapped.
            if (p > q) wrong += rows.from[1] != rows.to[1] || i + rows.to[0] < grid.nu;
        }
    }
    return wrong;
}

}  // namespace

TEST_CASE("every spring of a grid stands where its stencil says, and there is no other") {
    const Scene scene = scene_of_all_shapes();
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    REQUIRE(model.grids.size() == scene.cloths.size());
    std::uint32_t stretch = 0, shear = 0, bend = 0;
    for (const GridSprings& g : model.grids) {
        for (const SpringRows* rows : {&g.u, &g.v}) {
            CHECK(misplaced(g, *rows, model.springs) == 0);
            if (rows->count() > 0) CHECK(rows->first == stretch);
            stretch += rows->count();
        }
    }
    for (const GridSprings& g : model.grids) {
        for (const SpringRows* rows : {&g.diagonal, &g.anti}) {
            CHECK(misplaced(g, *rows, model.springs) == 0);
            if (rows->count() > 0) CHECK(rows->first == stretch + shear);
            shear += rows->count();
        }
        for (const SpringRows* rows : {&g.bend_u, &g.bend_v, &g.bend_diagonal, &g.bend_anti}) {
            CHECK(misplaced(g, *rows, model.bends) == 0);
            if (rows->count() > 0) CHECK(rows->first == bend);
            bend += rows->count();
        }
    }
    CHECK(stretch == model.springs.stretch_count);
    CHECK(stretch + shear == model.springs.size());
    CHECK(bend == model.bends.size());
    std::uint32_t curved = 0;
    for (const GridSprings& g : model.grids) {
        for (std::size_t f = 0; f < curvature_stencils.size(); ++f) {
            const SpringRows& rows = *curvature_rows(g)[f];
            const GridStencil& stencil = curvature_stencils[f];
            CHECK((rows.count() == 0 || rows.first == curved));
            curved += rows.count();
            for (std::uint32_t j = 0; j < rows.rows; ++j) {
                for (std::uint32_t i = 0; i < rows.per_row; ++i) {
                    const std::uint32_t s = rows.at(i, j);
                    REQUIRE(model.curvature.count(s) == stencil.count);
                    for (std::size_t k = 0; k < stencil.count; ++k) {
                        const auto [column, down] = stencil.at[k];
                        CHECK(model.curvature.p[s][k] == g.at((i + static_cast<std::uint32_t>(column)) % g.nu,
                                                              j + static_cast<std::uint32_t>(down)));
                        CHECK(model.curvature.w[k][s] == stencil.w[k]);
                    }
                }
            }
        }
    }
    CHECK(curved == model.curvature.size());
}

TEST_CASE("a stencil finds the springs of a particle that lists name, in the same order") {
    const Scene scene = scene_of_all_shapes();
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    REQUIRE(!model.spring_adjacency.grids.empty());
    REQUIRE(model.spring_adjacency.entries.empty());
    const Adjacency lists = adjacency_of(model.size(), model.springs.i, model.springs.j);
    const auto springs_of = [](const Adjacency& adjacency, std::uint32_t p) {
        std::vector<std::array<std::uint32_t, 2>> found;
        adjacency.each(p, [&](std::uint32_t s, std::uint32_t other) { found.push_back({s, other}); });
        return found;
    };
    for (std::uint32_t p = 0; p < model.size(); ++p) {
        INFO(p);
        REQUIRE(springs_of(model.spring_adjacency, p) == springs_of(lists, p));
    }
}

TEST_CASE("a cloth that bends nowhere has no bend springs, one that bends somewhere has them everywhere") {
    Scene scene;
    scene.cloths = {cloth_of("stiff", 6, 6, false)};
    scene.cloths[0].material.bend = 0;
    Placement placement;
    CHECK(build_model(scene, placement).bends.size() == 0);
    CHECK(build_model(scene, placement).curvature.size() == 0);
    Region region;
    region.box = {{0, 0}, {0.4, 1}};
    region.material = scene.cloths[0].material;
    region.material->bend = 1e-5;
    scene.cloths[0].regions.push_back(region);
    const auto some = [](const Coefficients& stiffness) {
        return std::ranges::min(stiffness.values()) == 0 && std::ranges::max(stiffness.values()) > 0;
    };
    scene.cloths[0].bend_model = BendModel::curvature;
    const ClothModel curved = build_model(scene, placement);
    CHECK(curved.curvature.size() == 2 * 6 * 4 + 5 * 5);
    CHECK(curved.bends.size() == 2 * 6 * 5);
    CHECK((some(curved.curvature.stiffness) && some(curved.bends.stiffness)));
    scene.cloths[0].bend_model = BendModel::buckling;
    const ClothModel model = build_model(scene, placement);
    CHECK(model.curvature.size() == 0);
    CHECK(model.bends.size() == 2 * 6 * 4 + 2 * 4 * 4);
    CHECK(some(model.bends.stiffness));
}
