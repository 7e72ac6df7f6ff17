#include "tool/report/component_table.hpp"

#include <catch2/catch.hpp>

using namespace unravel;
using namespace unravel::tool;

namespace {

// Particles 0 … 5 in a row with stretch springs between neighbours.
ClothModel row_of_six() {
    ClothModel model;
    model.mass.assign(6, 1.0);
    for (std::uint32_t p = 0; p + 1 < 6; ++p) {
        model.springs.i.push_back(p);
        model.springs.j.push_back(p + 1);
    }
    return model;
}

constexpr SpringState on = SpringState::implicit, off = SpringState::inactive;

}  // namespace

TEST_CASE("a component's row counts its particles, springs and the held particles beside it", "[report]") {
    // 0–1, held 2, 3–4–5: the spring 0–1 and both beside 2 are implicit.
    const std::vector<std::int32_t> component{0, 0, -1, 1, 1, 1};
    const std::vector<SpringState> springs{on, on, on, on, on};
    const std::vector<ComponentSolve> solves{{3, 9, 1e-4, true}, {5, 18, 2e-4, true}};
    const std::vector<Rgb> colors{{1, 0, 0}, {1, 0, 0}, {255, 255, 255}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}};
    const auto rows = component_table(row_of_six(), component, springs, solves, colors);
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].id == 1);  // the larger one comes first
    CHECK(rows[0].particles == 3);
    CHECK(rows[0].boundary == 1);
    CHECK(rows[0].springs == 3);
    CHECK(rows[0].solve.rvm == 18);
    CHECK(rows[0].color.r == 2);
    CHECK(rows[1].id == 0);
    CHECK(rows[1].particles == 2);
    CHECK(rows[1].boundary == 1);
    CHECK(rows[1].springs == 2);
}

TEST_CASE("a held particle that several springs tie to a component is one boundary particle", "[report]") {
    ClothModel model = row_of_six();
    model.springs.i.push_back(2);
    model.springs.j.push_back(4);
    const std::vector<std::int32_t> component{0, 0, -1, 1, 1, 1};
    const std::vector<Rgb> colors(6);
    const auto rows = component_table(model, component, std::vector<SpringState>(6, on), {}, colors);
    CHECK(rows[0].boundary == 1);
    CHECK(rows[0].springs == 4);
    CHECK(rows[0].solve.iterations == 0);  // before the first step nothing was solved
}

TEST_CASE("slack and explicit springs tie nothing to anything", "[report]") {
    const std::vector<std::int32_t> component{0, 1, -1, 2, 3, 4};
    const std::vector<SpringState> springs{off, SpringState::explicit_, off, off, off};
    const std::vector<Rgb> colors(6);
    for (const ComponentRow& row : component_table(row_of_six(), component, springs, {}, colors)) {
        CHECK(row.springs == 0);
        CHECK(row.boundary == 0);
    }
}
