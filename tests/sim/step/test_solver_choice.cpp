// Each component of a step says what solved it, and why.

#include <catch2/catch.hpp>
#include <utility>

#include "sim/step/step.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// Solves of the first step, in which all springs of the sheet are implicit.
std::vector<ComponentSolve> first_solves(std::vector<Cloth> cloths,
                                         SolveOptions solve = {Preconditioner::automatic}) {
    Scene scene;
    scene.cloths = std::move(cloths);
    Placement start;
    const ClothModel model = build_model(scene, start);
    ClothState state = initial_state(start);
    StepOptions options;
    options.integrator = Integrator::implicit;
    options.solve = solve;
    StepWorkspace ws;
    step(model, options, 1.0 / 200, state, ws);
    return ws.linear.solves;
}

// Taut everywhere, so that it is one component.
Cloth stretched(int n) {
    Cloth cloth = testing::sheet(n, 1);
    cloth.placed_scale = {1.05, 1.05};
    return cloth;
}

}  // namespace

TEST_CASE("a component says what solved it and why", "[solve]") {
    const auto only = [](const std::vector<ComponentSolve>& solves) {
        REQUIRE(solves.size() == 1);
        return solves.front();
    };
    const ComponentSolve large = only(first_solves({stretched(41)}));
    CHECK(large.by == SolvedBy::grid);
    CHECK(large.because == SolveReason::on_grid);
    const ComponentSolve small = only(first_solves({stretched(9)}));
    CHECK(small.by == SolvedBy::rows);
    CHECK(small.because == SolveReason::few_rows);
    const ComponentSolve asked = only(first_solves({stretched(41)}, {Preconditioner::constrained_block}));
    CHECK(asked.by == SolvedBy::rows);
    CHECK(asked.because == SolveReason::asked);
    const ComponentSolve cycles = only(first_solves({stretched(41)}, {Preconditioner::multigrid}));
    CHECK(cycles.by == SolvedBy::multigrid);
    CHECK(cycles.because == SolveReason::asked);
    // Stiff enough that blocks would need many iterations.
    Cloth stiff = stretched(81);
    stiff.material.stretch = {50000, 50000};
    const ComponentSolve expected = only(first_solves({stiff}));
    CHECK(expected.by == SolvedBy::multigrid);
    CHECK(expected.because == SolveReason::many_expected);
}

TEST_CASE("a particle that nothing implicit couples is solved by its block, or not at all", "[solve]") {
    Cloth alone = testing::sheet(1, 1);
    alone.name = "alone";
    const std::vector<ComponentSolve> solves = first_solves({stretched(9), alone});
    REQUIRE(solves.size() == 2);
    CHECK(solves.back().by == SolvedBy::block);
    CHECK(solves.back().because == SolveReason::one_row);
    const std::vector<ComponentSolve> none = first_solves({alone});
    REQUIRE(none.size() == 1);
    CHECK(none.front().by == SolvedBy::nothing);
    CHECK(none.front().because == SolveReason::nothing_implicit);
}
