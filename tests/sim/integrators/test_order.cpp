// Orders of convergence on problems whose answer is known in closed form, or certified by a far finer run of
// a classical Runge–Kutta method that shares nothing with the schemes but the forces' definition.

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "sim/step/step.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

struct Problem {
    ClothModel model;
    Placement start;
    double duration = 0;
};

void add_spring(Problem& p, std::uint32_t i, std::uint32_t j, double rest, double stiffness, double damping) {
    p.model.springs.i.push_back(i);
    p.model.springs.j.push_back(j);
    p.model.springs.rest.push_back(rest);
    p.model.springs.stiffness.push_back(stiffness);
    p.model.springs.damping.push_back(damping);
}

void pin(Problem& p, std::uint32_t particle) {
    PinnedGroup group;
    group.particles = {particle};
    group.start = {p.start.x[particle]};
    group.centre = group.start[0];
    group.release = std::numeric_limits<double>::infinity();
    p.model.pins.push_back(group);
}

void finish(Problem& p) {
    p.model.springs.stretch_count = p.model.springs.size();
    p.model.spring_adjacency = adjacency_of(p.start.x.size(), p.model.springs.i, p.model.springs.j);
}

// n equal masses between two walls on taut springs, moved along the line: x_k = k d + a sin(π k/(n+1)) cos
// ωt, ω = 2 √(k_s/m) sin(π/(2(n+1))). All springs stay in extension, so that the forces are linear.
constexpr int chain_masses = 9;
constexpr double chain_stiffness = 40, chain_mass = 0.1, chain_rest = 0.08, chain_gap = 0.1,
                 chain_swing = 0.01;

double chain_mode(int k) {
    return std::sin(M_PI * k / (chain_masses + 1));
}

Problem chain() {
    Problem p;
    p.duration = 1.0;
    for (int k = 0; k <= chain_masses + 1; ++k) {
        p.model.mass.push_back(chain_mass);
        p.start.x.emplace_back(chain_gap * k + chain_swing * chain_mode(k), 0, 0);
        p.start.v.emplace_back(0, 0, 0);
        if (k > 0)
            add_spring(p, static_cast<std::uint32_t>(k - 1), static_cast<std::uint32_t>(k), chain_rest,
                       chain_stiffness, 0);
    }
    pin(p, 0);
    pin(p, chain_masses + 1);
    finish(p);
    return p;
}

std::vector<Vec3> chain_at(double t) {
    const double omega =
        2 * std::sqrt(chain_stiffness / chain_mass) * std::sin(M_PI / (2 * (chain_masses + 1)));
    std::vector<Vec3> x;
    for (int k = 0; k <= chain_masses + 1; ++k)
        x.emplace_back(chain_gap * k + chain_swing * chain_mode(k) * std::cos(omega * t), 0, 0);
    return x;
}

// Two masses on two springs that swing as a double pendulum, stretched from the start and never slack, with
// damping: nonlinear in position and velocity.
Problem pendulum() {
    Problem p;
    p.duration = 0.5;
    p.model.gravity = {0, -9.81, 0};
    p.model.mass = {0.1, 0.1, 0.07};
    p.start.x = {{0, 0, 0}, {0.18, -0.39, 0}, {0.28, -0.79, 0.05}};
    p.start.v = {{0, 0, 0}, {0.1, 0.05, 0.3}, {0.1, 0, 0.4}};
    add_spring(p, 0, 1, 0.4, 60, 0.02);
    add_spring(p, 1, 2, 0.4, 40, 0.02);
    pin(p, 0);
    finish(p);
    return p;
}

// A small sheet stretched by 8% in a fixed frame, sagging under gravity: the trampoline, every spring taut.
Problem trampoline() {
    Scene scene;
    Cloth cloth;
    cloth.particles = {7, 7};
    cloth.placed_scale = {1.08, 1.08};
    cloth.material.stretch = {50, 50};
    cloth.material.shear = 5;
    for (const char* edge : {"u0", "u1", "v0", "v1"}) {
        Pin frame;
        frame.target = PinTarget::edge;
        frame.name = edge;
        cloth.pins.push_back(frame);
    }
    scene.cloths.push_back(cloth);
    Problem p;
    p.model = build_model(scene, p.start);
    p.duration = 0.25;
    return p;
}

// A zigzag of taut springs with bend springs in compression from each particle to the next but one: bending
// that never lets go, where what a scheme makes of it is seen.
Problem zigzag() {
    Problem p;
    p.duration = 0.2;
    constexpr int count = 7;
    for (int k = 0; k < count; ++k) {
        p.model.mass.push_back(0.1);
        p.start.x.emplace_back(0.1 * k, k % 2 ? 0.04 : 0.0, 0.002 * k * k);
        p.start.v.emplace_back(0, 0, 0);
        if (k > 0)
            add_spring(p, static_cast<std::uint32_t>(k - 1), static_cast<std::uint32_t>(k), 0.085, 60, 0.02);
    }
    pin(p, 0);
    pin(p, count - 1);
    finish(p);
    BendSprings& bends = p.model.bends;
    for (std::uint32_t k = 0; k + 2 < count; ++k) {
        bends.i.push_back(k);
        bends.j.push_back(k + 2);
        bends.rest.push_back(0.24);
        bends.stiffness.push_back(4e-3);
        bends.slope.push_back(5);
    }
    return p;
}

std::vector<Vec3> accelerations(const Problem& p, const std::vector<Vec3>& x, const std::vector<Vec3>& v) {
    std::vector<Vec3> a(x.size(), p.model.gravity);
    const auto push = [&](std::uint32_t i, std::uint32_t j, const Vec3& f) {
        a[i] += f / p.model.mass[i];
        a[j] -= f / p.model.mass[j];
    };
    const ExtensionSprings& s = p.model.springs;
    for (std::size_t k = 0; k < s.size(); ++k) {
        const Vec3 d = x[s.j[k]] - x[s.i[k]];
        const double l = d.norm();
        if (l <= s.rest[k]) continue;
        push(s.i[k], s.j[k],
             (s.stiffness[k] * (l - s.rest[k]) + s.damping[k] * (v[s.j[k]] - v[s.i[k]]).dot(d) / l) * d / l);
    }
    const BendSprings& b = p.model.bends;
    for (std::size_t k = 0; k < b.size(); ++k) {
        const Vec3 d = x[b.j[k]] - x[b.i[k]];
        push(b.i[k], b.j[k], bend_force(d.norm(), b.rest[k], b.stiffness[k], b.slope[k]) * d / d.norm());
    }
    const CurvatureStencils& c = p.model.curvature;
    for (std::size_t k = 0; k < c.size(); ++k) {
        const Vec3 pull = c.stiffness[k] * bend_of(c, k, x);
        for (std::uint32_t end = 0; end < c.count(k); ++end)
            a[c.p[k][end]] -= c.w[end][k] / p.model.mass[c.p[k][end]] * pull;
    }
    for (const PinnedGroup& group : p.model.pins) {
        for (const std::uint32_t q : group.particles) a[q].setZero();
    }
    return a;
}

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

StepOptions options_of(Integrator integrator) {
    StepOptions options;
    options.integrator = integrator;
    options.threshold = 0.05;
    options.solve.tolerance = 1e-11;  // the solver's error is to be far below the schemes'
    return options;
}

// Step sizes follow `pattern` (relative), over and over, so many that they fill the duration.
std::vector<Vec3> integrate(const Problem& p, const StepOptions& options, int steps,
                            const std::vector<double>& pattern = {1.0}) {
    ClothState state = initial_state(p.start);
    StepWorkspace ws;
    double whole = 0;
    for (int n = 0; n < steps; ++n) whole += pattern[static_cast<std::size_t>(n) % pattern.size()];
    for (int n = 0; n < steps; ++n) {
        step(p.model, options, p.duration * pattern[static_cast<std::size_t>(n) % pattern.size()] / whole,
             state, ws);
    }
    return state.x;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
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
