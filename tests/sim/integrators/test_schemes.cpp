// What schemes are beside their order: what they become at a limit, and how long they stay stable.

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/sim/integrators/problems.hpp"

using namespace unravel;
using namespace unravel::sim;

// The smaller h, the fewer springs are implicit: what adaptive IMEX does to a step vanishes with h.
TEST_CASE("split_step_tends_to_implicit_step") {
    const Problem p = pendulum();
    const auto apart = [&](int steps) {
        return distance(integrate(p, options_of(Integrator::adaptive_imex), steps),
                        integrate(p, options_of(Integrator::implicit), steps));
    };
    const double coarse = apart(200), fine = apart(800);
    CHECK(coarse > 0);
    CHECK(fine < coarse / 3);  // first order: a fourth, less what is left of the second
}

// Without a threshold no stretch or shear spring is explicit, and but for bending the adaptive schemes are
// the all-implicit ones, bit for bit.
TEST_CASE("adaptive_schemes_with_threshold_zero_are_the_implicit_ones") {
    const Problem p = trampoline();
    const auto with = [&](Integrator integrator, BendTreatment bend) {
        StepOptions options = options_of(integrator);
        options.threshold = 0;
        options.bend = bend;
        return integrate(p, options, 25);
    };
    CHECK(with(Integrator::adaptive_imex, BendTreatment::scheme) ==
          with(Integrator::implicit, BendTreatment::explicit_));
    CHECK(with(Integrator::adaptive_imex2, BendTreatment::scheme) ==
          with(Integrator::bdf2, BendTreatment::scheme));
}

// Forward–backward Euler as Eq. (3) has it, written down once more.
TEST_CASE("explicit_step_is_forward_backward_euler") {
    const Problem p = trampoline();
    const double h = p.duration / 100;
    std::vector<Vec3> x = p.start.x, v = p.start.v;
    for (int n = 0; n < 100; ++n) {
        const std::vector<Vec3> a = accelerations(p, x, v);
        for (std::size_t k = 0; k < x.size(); ++k) {
            v[k] += h * a[k];
            x[k] += h * v[k];
        }
    }
    // Sums in another order: a few units of rounding a step.
    CHECK(distance(x, integrate(p, options_of(Integrator::explicit_), 100)) < 1e-13);
}

// The fastest mode of a chain has h²ω² = 4κ. Near the stated limit of 3.2 every spring is explicit and no
// mode may grow: SBDF2's own extrapolation feeds them at any step.
TEST_CASE("explicit_half_of_the_second_order_pair_is_stable_up_to_its_limit") {
    Problem p = chain();
    const double h = std::sqrt(0.79 * chain_mass / chain_stiffness);
    for (std::size_t k = 1; k <= chain_masses; ++k) p.start.x[k].x() += k % 2 ? 0.001 : -0.001;
    StepOptions options = options_of(Integrator::adaptive_imex2);
    options.threshold = 0.8;
    ClothState state = initial_state(p.start);
    StepWorkspace ws;
    for (int n = 0; n < 2000; ++n) {
        const StepReport report = step(p.model, options, h, state, ws);
        REQUIRE(report.implicit == 0);
    }
    for (std::size_t k = 1; k <= chain_masses; ++k)
        CHECK(std::abs(state.x[k].x() - chain_gap * static_cast<double>(k)) < chain_swing);
}

// Euler's implicit schemes damp; none of them may add energy to a free swing without input.
TEST_CASE("implicit_schemes_add_no_energy") {
    const Problem p = trampoline();
    for (const Integrator integrator : {Integrator::implicit, Integrator::newton, Integrator::bdf2}) {
        StepOptions options = options_of(integrator);
        ClothState state = initial_state(p.start);
        StepWorkspace ws;
        double highest = -std::numeric_limits<double>::infinity(), first = 0;
        for (int n = 0; n < 200; ++n) {
            const StepReport report = step(p.model, options, 1.0 / 200, state, ws);
            if (n == 0) first = report.kinetic + report.potential;
            highest = std::max(highest, report.kinetic + report.potential);
        }
        INFO(scheme_of(integrator).name);
        CHECK(highest - first < 1e-3 * std::abs(first));
    }
}

// A stiff cloth swinging down: springs slack and taut by turns, far beyond where orders show.
TEST_CASE("second_order_steps_do_not_overshoot_on_a_stiff_hanging_cloth") {
    Scene scene;
    Cloth cloth;
    cloth.particles = {15, 15};
    cloth.material.stretch = {5000, 5000};
    cloth.material.shear = 110;
    Pin held;
    held.target = PinTarget::corner;
    for (const char* corner : {"u0v0", "u1v0"}) held.name = corner, cloth.pins.push_back(held);
    scene.cloths.push_back(cloth);
    Problem p;
    p.model = build_model(scene, p.start);
    p.duration = 0.4;
    StepOptions options = options_of(Integrator::implicit);
    const std::vector<Vec3> damped = integrate(p, options, 640);
    options.integrator = Integrator::bdf2;
    for (const int steps : {80, 160}) CHECK(distance(integrate(p, options, steps), damped) < 0.05);
}
