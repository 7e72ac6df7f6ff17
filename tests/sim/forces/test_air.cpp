// Air on a cell in closed form, winds that change, and cloth so light that the air outruns the step.

#include "sim/forces/air.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::sim;

TEST_CASE("drag acts along a cell's normal, lift along the cell") {
    AirCells air;
    air.corners = {{0, 1, 2, 3}};
    connect_cells(4, air);
    const double side = 0.1;
    const std::vector<Vec3> x{{0, 0, 0}, {0, 0, side}, {side, 0, side}, {side, 0, 0}}, v(4, Vec3(0, 0.5, 0));
    const std::vector<double> mass(4, 10.0);  // heavy: no bound on what the cell can bear
    Wind wind;
    wind.velocity = {3, 2.5, 0};
    wind.drag = 1.1;
    wind.lift = 0.3;
    std::vector<Vec3> force(1);
    air_forces(air, wind, 0, 0.001, mass, x, v, force);
    const double half = 0.5 * 1.2 * side * side;
    CHECK(force[0].y() == Approx(half * 1.1 * 2 * 2));
    CHECK(force[0].x() == Approx(half * 0.3 * std::sqrt(13.0) * 3));
    CHECK(std::abs(force[0].z()) < 1e-15);
    // The same from below: drag always goes with the wind.
    wind.velocity = {3, -1.5, 0};
    air_forces(air, wind, 0, 0.001, mass, x, v, force);
    CHECK(force[0].y() == Approx(-half * 1.1 * 2 * 2));
}

TEST_CASE("a gust is a smooth function of its seed, with the deviation that it says") {
    Wind wind;
    wind.velocity = {4, 0, 0};
    wind.gust = Gust{0.35, 0.7, 5};
    Wind other = wind;
    other.gust->seed = 6;
    double mean = 0, square = 0, different = 0, jump = 0, before = wind_velocity(wind, 0).x();
    const int n = 200000;
    const double dt = 0.01;
    for (int k = 0; k < n; ++k) {
        const double speed = wind_velocity(wind, k * dt).x();
        CHECK(speed == wind_velocity(wind, k * dt).x());
        mean += speed / n;
        square += speed * speed / n;
        different = std::max(different, std::abs(speed - wind_velocity(other, k * dt).x()));
        jump = std::max(jump, std::abs(speed - before));
        before = speed;
    }
    CHECK(mean == Approx(4).epsilon(0.02));
    CHECK(std::sqrt(square - mean * mean) == Approx(0.35 * 4).epsilon(0.05));
    CHECK(different > 1);
    // From one extreme to the other within a period at the steepest of the cubic, 1.5 times the mean slope.
    CHECK(jump < 2 * std::sqrt(3.0) * std::sqrt(35.0 / 26.0) * 0.35 * 4 * 1.5 * dt / 0.7 * 1.001);
}

TEST_CASE("a keyframed wind meets its keyframes, is straight between and steady outside") {
    Wind wind;
    wind.velocity = {9, 9, 9};
    wind.keyframes = {{1.0, {0, 0, 0}}, {2.0, {4, 0, 2}}, {4.0, {0, 0, -2}}};
    CHECK(wind_velocity(wind, 0).isZero());
    CHECK(wind_velocity(wind, 1).isZero());
    CHECK((wind_velocity(wind, 1.25) - Vec3(1, 0, 0.5)).norm() < 1e-15);
    CHECK(wind_velocity(wind, 2) == Vec3(4, 0, 2));
    CHECK((wind_velocity(wind, 3) - Vec3(2, 0, 0)).norm() < 1e-15);
    CHECK(wind_velocity(wind, 10) == Vec3(0, 0, -2));
}

TEST_CASE("the air brings a light cell towards its own speed within a step, and never beyond") {
    for (const std::string shape : {"particles = [2, 2]", "particles = [3, 4]"}) {
        for (const double speed : {2.0, 20.0, 200.0}) {
            Simulation s = start_simulation(parse_scene(
                "gravity = [0, 0, 0]\n[cloth]\n" + shape +
                    "\nsize = [0.1, 0.1]\ndensity = 0.02\nrotation = [90, 0, 0]\n"
                    "[solver]\nstep = \"1/30\"\ntolerance = 1e-10\n[wind]\ndrag = 1.1\nvelocity = [0, 0, " +
                    std::to_string(speed) + "]\n",
                "cell.toml"));
            const StepReport report = next_step(s);
            CHECK(report.rejected == 0);
            // v' = (h c/m) w / (1 + h c/m), with c/m = ½ ρ C_d w / density, of a sheet that moves as one.
            const double share = 0.5 * 1.2 * 1.1 * speed / 0.02 / 30;
            double momentum = 0, mass = 0;
            for (std::size_t p = 0; p < s.model.size(); ++p) {
                momentum += s.model.mass[p] * s.state.v[p].z();
                mass += s.model.mass[p];
                CHECK(s.state.v[p].z() > 0);
            }
            const bool is_stiff = share > 0.5;  // certainly: at the lightest corner it is a quarter of that
            if (is_stiff) CHECK(momentum / mass == Approx(share / (1 + share) * speed).epsilon(0.02));
        }
    }
}

TEST_CASE("how far a wind bulges a light cloth depends on no step") {
    const auto bulge = [](const std::string& step, const std::string& integrator) {
        Simulation s = start_simulation(parse_scene(
            "gravity = [0, 0, 0]\n[cloth]\nparticles = [13, 13]\ndensity = 0.02\nrotation = [90, 0, 0]\n"
            "material = { stretch = 1000, shear = 20, bend = 1e-6, stretch_damping = 0.05 }\n"
            "[[cloth.pin]]\nedge = [\"v0\", \"v1\"]\n[solver]\nstep = \"" +
                step + "\"\nintegrator = \"" + integrator + "\"\n[wind]\nvelocity = [0, 0, 15]\n",
            "veil.toml"));
        for (int frame = 0; frame < 60; ++frame) next_record(s);
        return s.state.x[s.model.cloths[0].at(6, 6)].z();
    };
    const double fine = bulge("1/1920", "implicit");
    CHECK(fine > 0.1);
    CHECK(bulge("1/60", "implicit") == Approx(fine).epsilon(0.01));
    CHECK(bulge("1/240", "adaptive-imex") == Approx(fine).epsilon(0.01));
    CHECK(bulge("1/240", "newton") == Approx(fine).epsilon(0.01));
}

TEST_CASE("a small piece of silk flutters in a strong wind") {
    Simulation s = start_simulation(
        parse_scene("[clip]\nduration = 0.5\n[cloth]\nparticles = [21, 21]\nsize = [0.05, 0.05]\n"
                    "rotation = [90, 0, 0]\nmaterial = { preset = \"silk\" }\n[[cloth.pin]]\nedge = \"v0\"\n"
                    "[wind]\nvelocity = [0, 0, 10]\n",
                    "silk.toml"));
    double most = 0, least = 1;
    for (int frame = 0; frame < 15; ++frame) {
        for (const StepReport& report : next_record(s).reports) CHECK(report.max_strain < 0.5);
        const double height = s.state.x[s.model.cloths[0].at(10, 20)].y();
        if (frame < 5) continue;
        most = std::max(most, height);
        least = std::min(least, height);
    }
    CHECK(most - least > 0.001);
}
