#include "source_dir.hpp"
#include "tool/inspect/pattern.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

using Entries = std::set<std::array<std::uint32_t, 2>>;

Entries set_of(const Pattern& pattern) {
    return {pattern.entries.begin(), pattern.entries.end()};
}

// A cloth on a sphere after a while: some of it held, some slack.
Simulation draped() {
    const Scene scene =
        load_scene(UNRAVEL_SOURCE_DIR "/scenes/drape_sphere.toml", {"cloth.particles=[15,20]"});
    Simulation simulation = start_simulation(scene);
    for (int k = 0; k < 14; ++k) next_record(simulation);
    return simulation;
}

}  // namespace

TEST_CASE("the implicit scheme's pattern has a block per particle and two per coupled pair", "[inspect]") {
    const Scene scene = parse_scene("[cloth]\nparticles = [3, 3]\n", "grid", ".");
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const Pattern pattern = implicit_pattern(model);
    Entries expected;
    for (std::uint32_t p = 0; p < 9; ++p) expected.insert({p, p});
    const auto couple = [&](std::uint32_t i, std::uint32_t j) {
        expected.insert({i, j});
        expected.insert({j, i});
    };
    for (std::size_t s = 0; s < model.springs.size(); ++s) couple(model.springs.i[s], model.springs.j[s]);
    for (std::size_t s = 0; s < model.bends.size(); ++s) couple(model.bends.i[s], model.bends.j[s]);
    const CurvatureStencils& stencils = model.curvature;
    for (std::size_t s = 0; s < stencils.size(); ++s)
        for (std::uint32_t a = 0; a < stencils.count(s); ++a)
            for (std::uint32_t b = a + 1; b < stencils.count(s); ++b)
                couple(stencils.p[s][a], stencils.p[s][b]);
    CHECK(set_of(pattern) == expected);
    // 9 on the diagonal, and of 12 stretch and 8 shear springs and of 6 ends of lines of three two each:
    // bending couples no others, and none doubles another.
    CHECK(pattern.entries.size() == 9 + 2 * (12 + 8 + 6));
}

TEST_CASE("the step's pattern is that of the system which was solved", "[inspect]") {
    const Simulation simulation = draped();
    const System& A = simulation.ws.linear.system;
    const Components& components = simulation.ws.linear.components;
    REQUIRE(components.count() > 1);
    const Pattern assembled = step_pattern(simulation.model, simulation.ws.forces.memory.springs.state, {});
    const Pattern reordered = reordered_pattern(assembled, components);
    Entries solved;
    const std::uint32_t rows = components.start.back();
    for (std::uint32_t row = 0; row < A.rows(); ++row) solved.insert({row, row});
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t e = A.start[row]; e < A.start[row + 1]; ++e)
            solved.insert({row, A.entries[e].column});
    }
    CHECK(set_of(reordered) == solved);
}

TEST_CASE("every block of the reordered pattern lies within its component", "[inspect]") {
    const Simulation simulation = draped();
    const Pattern reordered =
        reordered_pattern(step_pattern(simulation.model, simulation.ws.forces.memory.springs.state, {}),
                          simulation.ws.linear.components);
    REQUIRE(reordered.blocks.size() == simulation.ws.linear.components.count());
    std::vector<std::size_t> owner(reordered.rows, reordered.blocks.size());
    for (std::size_t c = 0; c < reordered.blocks.size(); ++c) {
        for (std::uint32_t row = reordered.blocks[c][0]; row < reordered.blocks[c][1]; ++row) owner[row] = c;
    }
    for (const auto& [row, column] : reordered.entries) {
        if (row != column) CHECK(owner[row] == owner[column]);
    }
}

TEST_CASE("patterns of few and of ten thousand rows can be drawn", "[inspect]") {
    for (const std::uint32_t rows : {1u, 300u, 10000u}) {
        Pattern pattern{"diagonal", rows, {}, {{0, rows}}};
        for (std::uint32_t row = 0; row < rows; ++row) pattern.entries.push_back({row, row});
        const Image image = pattern_image(pattern, 1);
        int dark = 0;
        for (int y = 60; y < 500; ++y) {
            for (int x = 80; x < 530; ++x) dark += image.at(x, y)[0] < 200;
        }
        CAPTURE(rows);
        CHECK(dark > 300);  // the diagonal is seen whatever the size
        CHECK(pattern_svg(pattern).size() < std::size_t{2} << 20);
    }
}
