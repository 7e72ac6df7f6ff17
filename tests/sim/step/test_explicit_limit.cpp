#include "sim/step/explicit_limit.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/step/choose_integrator.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// A sheet held all round and stretched, so that every spring acts: what explicit Euler bears shows in it.
Simulation stretched_sheet(const std::vector<std::string>& set = {}) {
    return start_simulation(parse_scene(
        "gravity = [0, 0, 0]\n[clip]\nfps = 25\n[cloth]\nparticles = [9, 9]\nsize = [0.4, 0.4]\n"
        "placed_scale = [1.05, 1.05]\njitter = 1e-5\n"
        "material = { stretch = 100, stretch_damping = 0, shear = 25, shear_damping = 0, bend = 0 }\n"
        "[[cloth.pin]]\nedge = [\"u0\", \"u1\", \"v0\", \"v1\"]\n"
        "[solver]\nintegrator = \"explicit\"\nstep = \"1/200\"\n",
        "sheet.toml", {}, set));
}

// A push in the sheet's own plane that alternates from particle to particle: the stiffest mode.
bool stays_bounded(double h) {
    Simulation s = stretched_sheet();
    for (std::uint32_t p = 0; p < s.state.v.size(); ++p)
        s.state.v[p] += Vec3((p % 9 + p / 9) % 2 == 0 ? 1e-6 : -1e-6, 0, 0);
    try {
        for (int k = 0; k < 2000; ++k) step(s.model, s.options, h, s.state, s.ws);
    } catch (const SimulationError&) {
        return false;
    }
    double fastest = 0;
    for (const Vec3& v : s.state.v) fastest = std::max(fastest, v.norm());
    return fastest < 1e-2;
}

}  // namespace

TEST_CASE("explicit Euler holds up to the stated step and not far beyond") {
    const Simulation s = stretched_sheet();
    const double largest = explicit_limit(s.model, s.options, 1.0 / 200).step;
    CHECK(stays_bounded(0.98 * largest));
    // The bound adds up springs that no single mode stretches all at once: it may be short of the truth, by a
    // third at most on a grid.
    CHECK_FALSE(stays_bounded(1.5 * largest));
}

TEST_CASE("the bound is 8 kappa / 4 inside a grid whose springs share one kappa") {
    const Simulation s = stretched_sheet();
    const ExplicitLimit limit = explicit_limit(s.model, s.options, 1e-3);
    // Square cells of 5 cm, particles of 0.5 g: shear springs have twice the modulus, which the threads leave
    // to them.
    const double stretch = kappa(1e-3, 1 / 5e-4, 50, 0), shear = kappa(1e-3, 1 / 5e-4, 50, 0);
    CHECK(limit.share == Approx(stretch + shear).epsilon(1e-9));
    CHECK(explicit_limit(s.model, s.options, limit.step).share == Approx(1).epsilon(1e-9));
}

TEST_CASE("a step beyond the limit is refused with the largest that holds") {
    Simulation s = stretched_sheet();
    CHECK_THROWS_WITH(require_explicit_stability(s.model, s.options, 0.1),
                      Catch::Contains("largest stable step") && Catch::Contains("kappa"));
    CHECK_NOTHROW(require_explicit_stability(s.model, s.options, 1e-4));
    s.options.integrator = Integrator::implicit;
    CHECK_NOTHROW(require_explicit_stability(s.model, s.options, 0.1));
    s.options.integrator = Integrator::adaptive_imex;
    CHECK_NOTHROW(require_explicit_stability(s.model, s.options, 0.1));
    s.options.threshold = 1e6;
    CHECK_THROWS_WITH(require_explicit_stability(s.model, s.options, 0.1), Catch::Contains("threshold"));
}

TEST_CASE("what would take more substeps than can be counted is refused, and auto goes the other way") {
    const auto hard = [](const char* integrator) {
        return start_simulation(parse_scene(
            "[cloth]\nparticles = [21, 21]\nsize = [0.1, 0.1]\nmaterial = { stretch_damping = 1e6 }\n"
            "[[cloth.pin]]\ncorner = \"u0v0\"\n[solver]\nsubsteps = 0\nintegrator = \"" +
                std::string(integrator) + "\"\n",
            "hard.toml"));
    };
    Simulation divided = hard("explicit"), automatic = hard("auto");
    CHECK_THROWS_AS(require_explicit_stability(divided.model, divided.options, 1.0 / 240), UnstableStep);
    require_explicit_stability(automatic.model, automatic.options, 1.0 / 240);
    const IntegratorCosts costs =
        count_costs(automatic.model, automatic.options, 1.0 / 240, automatic.ws.plan);
    CHECK(costs.substeps > 1e9);
    CHECK(costs.cheaper() == Integrator::adaptive_imex);
}
