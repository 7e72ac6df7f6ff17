// Coulomb's friction where it has a closed form: a rope round a cylinder, a slope, a block that slides.

#include "sim/constraints/friction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/run/simulate.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

// The capstan equation of a heavy strip over a cylinder, from the light side (p = 0) over the top (p = π),
// tensions in lengths of the strip's own weight, R up to its middle:
//   dT/dp = R cos p + μ (T + R sin p)
double tension_behind(double R, double before, double mu) {
    const int n = 2000;
    const double d = std::numbers::pi / n;
    const auto slope = [&](double T, double p) { return R * std::cos(p) + mu * (T + R * std::sin(p)); };
    double T = before;
    for (int k = 0; k < n; ++k) T += d * slope(T + 0.5 * d * slope(T, k * d), (k + 0.5) * d);
    return T;
}

// Of a strip that hangs by `light` and `heavy` on either side: the friction at which it just holds.
double friction_at_limit(double R, double light, double heavy) {
    double low = 0, high = 2;
    for (int k = 0; k < 50; ++k) {
        const double mu = 0.5 * (low + high);
        (tension_behind(R, light, mu) < heavy ? low : high) = mu;
    }
    return low;
}

struct Capstan {
    std::string obj;
    double limit = 0;  ///< friction at which it just holds
};

// A strip one cell wide, laid over a cylinder of radius R (m) and its skin without any strain; it hangs by
// 30 cm on one side and by what friction mu holds on the other.
Capstan laid_over(double radius, double mu) {
    const double R = radius + 0.004, light = 0.3;
    const int arc = std::max(12, static_cast<int>(std::lround(R * std::numbers::pi / 0.012)));
    const double turn = std::numbers::pi / arc, c = 2 * R * std::sin(0.5 * turn);
    const int before = static_cast<int>(std::lround(light / c)),
              behind = static_cast<int>(std::lround(tension_behind(R, light, mu) / c));
    Capstan out;
    out.limit = friction_at_limit(R, before * c, behind * c);
    const auto put = [&](double x, double y) {
        for (const double z : {-0.5 * c, 0.5 * c})
            out.obj += fmt::format("v {:.12g} {:.12g} {:.12g}\n", x, y, z);
    };
    for (int k = before; k > 0; --k) put(-R, 1.5 - k * c);
    for (int k = 0; k <= arc; ++k) put(-R * std::cos(k * turn), 1.5 + R * std::sin(k * turn));
    for (int k = 1; k <= behind; ++k) put(R, 1.5 - k * c);
    for (int k = 0; k < before + arc + behind; ++k)
        out.obj += fmt::format("f {} {} {} {}\n", 2 * k + 1, 2 * k + 2, 2 * k + 4, 2 * k + 3);
    return out;
}

// How far the heavy end has come down in half a second [m], and how much the strip is stretched.
struct Slip {
    double down, strain;
};
Slip slip_of(const Capstan& capstan, double radius, double mu, const char* step) {
    const MeshScene made(
        fmt::format("[clip]\nfps = 20\n[cloth]\nmesh = \"mesh.obj\"\ndensity = 0.2\n"
                    "material = {{ stretch = 2000, stretch_damping = 0.5, shear = 1, bend = 0 }}\n"
                    "[[solid]]\nshape = \"cylinder\"\nradius = {}\nheight = 0.4\ncenter = [0, 1.5, 0]\n"
                    "rotation = [90, 0, 0]\nfriction = {{ static = {:.9g}, kinetic = {:.9g} }}\n"
                    "[solver]\nstep = \"{}\"\ntolerance = 1e-5\n",
                    radius, mu, mu, step),
        capstan.obj);
    Simulation s = start_simulation(made.scene);
    StepReport last = next_record(s).reports.back();
    const double start = last.lowest;
    for (int frame = 1; frame < 10; ++frame) last = next_record(s).reports.back();
    return {start - last.lowest, last.max_strain};
}

}  // namespace

TEST_CASE("a strip over a cylinder holds below the capstan's limit and slips above it", "[friction]") {
    for (const auto& [radius, mu] : {std::pair{0.05, 0.1}, {0.05, 0.3}, {0.1, 0.5}}) {
        INFO(radius << " " << mu);
        const Capstan capstan = laid_over(radius, mu);
        const double weight = 0.2 * 9.81 * tension_behind(radius, 0.3, mu);  // N/m
        const Slip held = slip_of(capstan, radius, capstan.limit / 0.95, "1/400"),
                   slid = slip_of(capstan, radius, capstan.limit / 1.05, "1/400");
        // What creeps goes at a millimetre a second; what slides is driven by a twentieth of what friction
        // bears.
        CHECK(held.down < 0.5 * creep_speed);
        CHECK(slid.down > 5e-3);
        CHECK(slid.strain < 1.5 * weight / 2000);
    }
}

TEST_CASE("what a strip over a cylinder does depends on no step", "[friction]") {
    const Capstan capstan = laid_over(0.05, 0.3);
    CHECK(slip_of(capstan, 0.05, capstan.limit / 0.95, "1/1600").down < 0.5 * creep_speed);
    CHECK(slip_of(capstan, 0.05, capstan.limit / 1.05, "1/1600").down > 5e-3);
}

TEST_CASE("a sheet on a slope stays below the angle of friction, and slides with what is left above",
          "[friction]") {
    // 4 mm off a plane of slope ½, from rest.
    const auto slid = [](double mu) {
        Simulation s = start_simulation(parse_scene(
            fmt::format("[clip]\nfps = 25\n[cloth]\nparticles = [9, 9]\nsize = [0.3, 0.3]\n"
                        "center = [-0.0017889, 0.5035777, 0]\nrotation = [0, 0, 26.5650512]\n"
                        "material = {{ stretch = 500, shear = 5 }}\n[[solid]]\nshape = \"plane\"\n"
                        "center = [0, 0.5, 0]\nrotation = [0, 0, 26.5650512]\n"
                        "friction = {{ static = {}, kinetic = {} }}\n",
                        mu, mu),
            "slope.toml"));
        const Vec3 start = s.state.x[40];
        for (int frame = 0; frame < 25; ++frame) next_record(s);
        return (s.state.x[40] - start).norm();
    };
    CHECK(slid(0.51) < 1e-7);  // the places above have seven digits
    // ½ (sin α − μ cos α) g t², within what the first steps take to know their speed.
    CHECK(slid(0.25) == Approx(0.5 * 9.81 * (0.5 - 0.25) * std::cos(std::atan(0.5))).epsilon(0.03));
}

TEST_CASE("a sheet that slides on a table is slowed by friction alone, and stops", "[friction]") {
    Simulation s = start_simulation(parse_scene(
        "[clip]\nfps = 20\n[cloth]\nparticles = [9, 9]\nsize = [0.3, 0.3]\ncenter = [0, 0.004, 0]\n"
        "velocity = [1, 0, 0]\nmaterial = { stretch = 500, shear = 5 }\n[[solid]]\nshape = \"plane\"\n"
        "friction = { static = 0.4, kinetic = 0.3 }\n[solver]\nstep = \"1/400\"\n",
        "table.toml"));
    for (int frame = 0; frame < 4; ++frame) next_record(s);
    CHECK(s.state.v[40].x() == Approx(1 - 0.3 * 9.81 * 0.2).epsilon(0.03));
    for (int frame = 4; frame < 20; ++frame) next_record(s);
    CHECK(s.state.v[40].norm() == 0);
}
