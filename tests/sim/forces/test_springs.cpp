// Stretch and shear springs: force against energy, Jacobian against force, and the splitting of Eq. (7).

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/forces/extension.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene_file/load.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

struct Pair {
    ExtensionSprings springs;
    std::vector<double> mass{0.01, 0.02};
    std::vector<Vec3> x{{0.1, 0.2, 0.3}, {0.4, 0.7, 0.1}};
    std::vector<Vec3> v{{0.3, -0.2, 0.1}, {-0.5, 0.4, 0.2}};

    explicit Pair(double stretched_by) {
        springs.i = {0};
        springs.j = {1};
        springs.rest = {(x[1] - x[0]).norm() / stretched_by};
        springs.stiffness = {50.0};
        springs.damping = {0.3};
        springs.stretch_count = 1;
    }
    ExtensionForces at(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                       const Splitting& splitting = {-1, -1}, double band = 0) const {
        ExtensionForces out;
        extension_forces(springs, mass, positions, velocities, 0.005, splitting, band, out);
        return out;
    }
};

// ∂f_i/∂x_j as the assembly builds it.
Mat3 position_jacobian(const ExtensionForces& f, double stiffness) {
    return (stiffness - f.transverse[0]) * f.direction[0] * f.direction[0].transpose() +
           f.transverse[0] * Mat3::Identity();
}

}  // namespace

TEST_CASE("extension force is minus the gradient of its energy") {
    Pair pair(1.07);
    pair.v.assign(2, Vec3::Zero());
    const Vec3 force = pair.at(pair.x, pair.v).force[0];
    const double d = 1e-6;
    for (int c = 0; c < 3; ++c) {
        const auto energy = [&](double shift) {
            std::vector<Vec3> x = pair.x;
            x[0][c] += shift;
            return extension_energy((x[1] - x[0]).norm(), pair.springs.rest[0], 50.0);
        };
        // Central differences err by d² of the third derivative, about 1e-9 of the force's scale here.
        CHECK(force[c] == Approx(-(energy(d) - energy(-d)) / (2 * d)).epsilon(1e-6));
    }
}

TEST_CASE("extension Jacobians match finite differences of the force, and the error falls with the step") {
    Pair pair(1.07);
    const std::vector<Vec3> rest_velocity(2, Vec3::Zero());
    const Mat3 dfdx = position_jacobian(pair.at(pair.x, rest_velocity), 50.0);
    const Mat3 dfdv =
        0.3 * pair.at(pair.x, pair.v).direction[0] * pair.at(pair.x, pair.v).direction[0].transpose();
    const auto difference = [&](double d, bool velocity) {
        Mat3 J;
        for (int c = 0; c < 3; ++c) {
            std::vector<Vec3> low = velocity ? pair.v : pair.x, high = low;
            low[1][c] -= d;
            high[1][c] += d;
            const auto force = [&](const std::vector<Vec3>& y) {
                return velocity ? pair.at(pair.x, y).force[0] : pair.at(y, rest_velocity).force[0];
            };
            J.col(c) = (force(high) - force(low)) / (2 * d);
        }
        return J;
    };
    const double coarse = (difference(1e-2, false) - dfdx).norm(),
                 fine = (difference(5e-3, false) - dfdx).norm();
    CHECK(coarse / fine == Approx(4.0).margin(0.2));  // second-order differences
    CHECK((difference(1e-5, false) - dfdx).norm() < 1e-6 * dfdx.norm());
    CHECK((difference(1e-5, true) - dfdv).norm() < 1e-8);
}

TEST_CASE("slack springs have neither force nor Jacobian, but in the band a Jacobian alone") {
    Pair pair(0.99);
    CHECK(pair.at(pair.x, pair.v).state[0] == SpringState::inactive);
    CHECK(pair.at(pair.x, pair.v).force[0].isZero());
    const ExtensionForces banded = pair.at(pair.x, pair.v, {-1, -1}, 0.02);
    CHECK(banded.state[0] == SpringState::implicit);
    CHECK(banded.force[0].isZero());
    CHECK(banded.transverse[0] == 0);
    // An explicit spring has no Jacobian for the band to keep.
    CHECK(pair.at(pair.x, pair.v, {1e9, 1e9}, 0.02).state[0] == SpringState::inactive);
}

TEST_CASE("coincident particles make no force and no NaN") {
    Pair pair(1.07);
    pair.x[1] = pair.x[0];
    pair.springs.rest.own()[0] = 0.0;
    const ExtensionForces f = pair.at(pair.x, pair.v);
    CHECK(f.force[0].isZero());
    CHECK(f.state[0] == SpringState::inactive);
}

TEST_CASE("a spring is explicit exactly where kappa of (7) is at most the threshold") {
    Pair pair(1.07);
    const double k = kappa(0.005, 1 / 0.01, 50.0, 0.3);  // the lighter end decides
    CHECK(k == Approx(0.005 / 0.01 * (50.0 * 0.005 + 2 * 0.3)));
    CHECK(pair.at(pair.x, pair.v, {k, k}).state[0] == SpringState::explicit_);
    const double below = std::nextafter(k, 0.0);
    CHECK(pair.at(pair.x, pair.v, {below, below}).state[0] == SpringState::implicit);
    // The force is the same either way: only its treatment differs.
    CHECK(pair.at(pair.x, pair.v, {k, k}).force[0] == pair.at(pair.x, pair.v, {below, below}).force[0]);
}

TEST_CASE("in extension the off-diagonal Jacobian is positive semidefinite") {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        Pair pair(1.0 + 0.5 * std::abs(seeded_uniform(seed, 0)) + 1e-6);
        const ExtensionForces f = pair.at(pair.x, pair.v);
        CHECK(f.transverse[0] >= 0);
        CHECK(f.transverse[0] <= 50.0);
    }
}

TEST_CASE("without shear stiffness there are no shear springs, whichever path the others take") {
    const auto scene_with = [](const char* integrator, const std::string& shear, const char* more) {
        return parse_scene(
            "[clip]\nfps = 25\n[cloth]\nparticles = [17, 14]\nsize = [0.5, 0.4]\ncenter = [0, 0.5, 0]\n"
            "material = { stretch = 60, shear = " +
                shear + ", bend = 1e-5 }\n[[cloth.pin]]\ncorner = [\"u0v0\", \"u1v0\"]\n" + more +
                "[solver]\nstep = \"1/" + (integrator == std::string("explicit") ? "2000" : "400") +
                "\"\nintegrator = \"" + integrator + "\"\n",
            "sheet.toml", {},
            // Components, where solves end, may be others: weak springs are edges of the graph, too.
            {integrator == std::string("explicit") || integrator == std::string("adaptive-imex")
                 ? "solver.tolerance=1e-3"
                 : "solver.tolerance=1e-11"});
    };
    for (const char* more :
         {"", "[[solid]]\nshape = \"sphere\"\nradius = 0.15\ncenter = [0, 0.3, 0]\n", "[self_collision]\n"})
        for (const char* integrator : {"explicit", "implicit", "adaptive-imex", "imex", "newton"}) {
            INFO(integrator << " " << more);
            Simulation none = start_simulation(scene_with(integrator, "0", more));
            // Springs too weak to move anything by a bit that counts.
            Simulation weak = start_simulation(scene_with(integrator, "1e-200, shear_damping = 0", more));
            CHECK(none.model.springs.size() == none.model.springs.stretch_count);
            CHECK(weak.model.springs.size() > weak.model.springs.stretch_count);
            testing::run_steps(none, 5);
            testing::run_steps(weak, 5);
            double apart = 0;
            for (std::size_t p = 0; p < none.model.size(); ++p)
                apart = std::max(apart, (none.state.x[p] - weak.state.x[p]).norm());
            CHECK(apart < 1e-7);
        }
}

TEST_CASE("a spring that was taken for taut and pushes keeps its Jacobian and loses its force") {
    // Three springs on lines of their own, implicit: left out and to be taut, marked and still slack, marked
    // and taut at the end.
    ExtensionSprings springs;
    std::vector<Vec3> x, v(6, Vec3::Zero()), end;
    const double before[] = {0.99, 0.9, 0.98}, after[] = {1.02, 0.95, 1.01};
    for (std::uint32_t s = 0; s < 3; ++s) {
        springs.add(2 * s, 2 * s + 1, 1.0, 100.0, 0.0);
        for (const double length : {0.0, before[s]}) x.emplace_back(length, s, 0);
        for (const double length : {0.0, after[s]}) end.emplace_back(length, s, 0);
    }
    springs.stretch_count = 3;
    const std::vector<double> mass(6, 1.0);
    constexpr double h = 0.1;
    std::vector<std::uint8_t> taut{0, 1, 1};
    ExtensionForces forces;
    extension_forces(springs, mass, x, v, h, {}, 0.0, forces, taut);
    CHECK(forces.force[1].x() == Approx(-10));
    const Misjudged wrong = correct_taut(springs, mass, h, {}, x, end, forces, 0.01, taut);
    CHECK(wrong.missed);
    // What the first one holds at the end, and what the second has pushed with on its way.
    CHECK(wrong.energy == Approx(0.5 * 100 * 0.02 * 0.02 + 100 * 0.05 * 0.05));
    CHECK(taut == std::vector<std::uint8_t>{1, 2, 1});

    extension_forces(springs, mass, x, v, h, {}, 0.0, forces, taut);
    for (const SpringState state : forces.state) CHECK(state == SpringState::implicit);
    CHECK(forces.force[1].isZero(0));
    const Misjudged again = correct_taut(springs, mass, h, {}, x, end, forces, 0.01, taut);
    CHECK(!again.missed);
    CHECK(again.energy == 0);
}
