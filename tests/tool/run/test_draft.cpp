#include "tool/run/draft.hpp"

#include <catch2/catch.hpp>

#include "sim/mesh/placement.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::tool;

TEST_CASE("a draft is a coarser grid of the same cloths, held where they were, and in as few steps") {
    const Scene scene = sim::parse_scene(
        "[clip]\nfps = 30\n[[cloth]]\nparticles = [101, 51]\nsize = [2, 1]\n[[cloth.pin]]\nparticles = [0, "
        "20, 50, 50]\n"
        "[[cloth.pin]]\nbox = [0.5, 0.5, 0.5, 0.5]\n[[cloth.pin]]\nedge = \"v0\"\ncount = 60\n"
        "[[cloth]]\nwrap = \"tube\"\nparticles = [40, 40]\ncenter = [4, 0, 0]\n[solver]\nstep = \"1/1200\"\n",
        "a.toml");
    const Scene draft = draft_of(scene, 900);
    const auto count = [](const Scene& s) {
        int particles = 0;
        for (const sim::Cloth& cloth : s.cloths) particles += cloth.particles[0] * cloth.particles[1];
        return particles;
    };
    CHECK(count(draft) < 1000);
    CHECK(count(draft) > 700);
    CHECK(draft.solver.step == Approx(1.0 / 240));
    CHECK(draft.cloths[0].size == scene.cloths[0].size);
    // A pin by indices keeps its share of the edge, and one in a place without a particle the nearest.
    const auto [nu, nv] = draft.cloths[0].particles;
    const auto& pins = draft.cloths[0].pins;
    CHECK(pins[0].range[2] == nv - 1);
    CHECK(pins[0].range[1] == std::lround(0.2 * (nu - 1)));
    for (const sim::Pin& pin : pins) CHECK(!sim::pinned_particles(draft.cloths[0], pin).empty());
    // What is small and quick already stays as it is.
    const Scene small = sim::parse_scene("[cloth]\nparticles = [20, 20]\n", "a.toml");
    CHECK(sim::scene_to_toml(draft_of(small)) == sim::scene_to_toml(small));
}
