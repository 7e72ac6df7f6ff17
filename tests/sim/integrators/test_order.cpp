// Orders of convergence on problems whose answer is known in closed form, or certified by a far finer run of
// a classical Runge–Kutta method that shares nothing with the schemes but the forces' definition.

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/integrators/problems.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// Classical fourth-order Runge–Kutta.
std::vector<Vec3> runge_kutta(const Problem& p, int steps) {
    const double h = p.duration / steps;
    std::vector<Vec3> x = p.start.x, v = p.start.v;
    const auto moved = [](const std::vector<Vec3>& y, double by, const std::vector<Vec3>& d) {
        std::vector<Vec3> out(y.size());
        for (std::size_t k = 0; k < y.size(); ++k) out[k] = y[k] + by * d[k];
        return out;
    };
    for (int n = 0; n < steps; ++n) {
        const auto a1 = accelerations(p, x, v);
        const auto v2 = moved(v, h / 2, a1), a2 = accelerations(p, moved(x, h / 2, v), v2);
        const auto v3 = moved(v, h / 2, a2), a3 = accelerations(p, moved(x, h / 2, v2), v3);
        const auto v4 = moved(v, h, a3), a4 = accelerations(p, moved(x, h, v3), v4);
        for (std::size_t k = 0; k < x.size(); ++k) {
            x[k] += h / 6 * (v[k] + 2 * v2[k] + 2 * v3[k] + v4[k]);
            v[k] += h / 6 * (a1[k] + 2 * a2[k] + 2 * a3[k] + a4[k]);
        }
    }
    return x;
}

// The answer by Runge–Kutta, which half as many steps confirm to `doubt` [m].
std::vector<Vec3> certified(const Problem& p, double doubt) {
    const std::vector<Vec3> exact = runge_kutta(p, 4000);
    REQUIRE(distance(exact, runge_kutta(p, 2000)) < doubt);
    return exact;
}

double observed_order(const Problem& p, Integrator integrator, const std::vector<Vec3>& exact, int steps,
                      const std::vector<double>& pattern = {1.0}) {
    const StepOptions options = options_of(integrator);
    const double coarse = distance(integrate(p, options, steps, pattern), exact);
    const double fine = distance(integrate(p, options, 2 * steps, pattern), exact);
    INFO(scheme_of(integrator).name << ": " << coarse << " " << fine);
    CHECK(fine > 1e-11);  // above the solver's own error, or the order says nothing
    return std::log2(coarse / fine);
}

constexpr Integrator schemes[] = {Integrator::explicit_,     Integrator::implicit, Integrator::newton,
                                  Integrator::imex,          Integrator::bdf2,     Integrator::adaptive_imex,
                                  Integrator::adaptive_imex2};

void require_orders(const Problem& p, const std::vector<Vec3>& exact, int steps, bool all_explicit = false) {
    for (const Integrator integrator : schemes) {
        const double order = observed_order(p, integrator, exact, steps);
        INFO(scheme_of(integrator).name);
        // The pair's explicit springs have their frequency right to fourth order and lose swing in the third.
        const bool better = all_explicit && integrator == Integrator::adaptive_imex2;
        CHECK(order == Approx(better ? 3 : scheme_of(integrator).order).margin(0.15));
    }
}

}  // namespace

TEST_CASE("halving_h_divides_the_error_by_two_to_the_order_on_a_chain") {
    const Problem p = chain();
    require_orders(p, chain_at(p.duration), 2000, true);
}

TEST_CASE("halving_h_divides_the_error_by_two_to_the_order_on_a_pendulum_of_springs") {
    const Problem p = pendulum();
    require_orders(p, certified(p, 1e-11), 800);
}

TEST_CASE("halving_h_divides_the_error_by_two_to_the_order_on_a_trampoline") {
    const Problem p = trampoline();
    require_orders(p, certified(p, 1e-10), 800);
}

TEST_CASE("halving_h_divides_the_error_by_two_to_the_order_on_a_zigzag_of_bend_springs") {
    const Problem p = zigzag();
    require_orders(p, certified(p, 1e-10), 800);
}

// Bend springs are edges of the implicit schemes' system, and of no other's.
TEST_CASE("implicit_and_newton_treat_bend_springs_implicitly_unless_told_not_to") {
    const Problem p = zigzag();
    const auto implicit_springs = [&](Integrator integrator, BendTreatment bend) {
        StepOptions options = options_of(integrator);
        options.bend = bend;
        ClothState state = initial_state(p.start);
        StepWorkspace ws;
        return step(p.model, options, 1e-3, state, ws).implicit;
    };
    const auto stretch = static_cast<std::uint32_t>(p.model.springs.size()),
               all = static_cast<std::uint32_t>(p.model.springs.size() + p.model.bends.size());
    for (const Integrator integrator : {Integrator::implicit, Integrator::newton}) {
        CHECK(implicit_springs(integrator, BendTreatment::scheme) == all);
        CHECK(implicit_springs(integrator, BendTreatment::explicit_) == stretch);
    }
    CHECK(implicit_springs(Integrator::bdf2, BendTreatment::scheme) == stretch);
    CHECK(implicit_springs(Integrator::imex, BendTreatment::scheme) == stretch);
}

// Growing and shrinking steps within a run: a multistep scheme that ignored the change would fall to order 1.
TEST_CASE("changing_steps_keep_the_order") {
    const Problem p = pendulum();
    const std::vector<Vec3> exact = certified(p, 1e-11);
    for (const Integrator integrator : {Integrator::bdf2, Integrator::adaptive_imex2}) {
        const double order = observed_order(p, integrator, exact, 800, {1.0, 1.6, 0.7, 0.7, 1.1});
        CHECK(order == Approx(2).margin(0.15));
    }
}
