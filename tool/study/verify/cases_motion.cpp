#include <fmt/format.h>

#include <cmath>

#include "tool/study/verify/verify_cases.hpp"
#include "tool/study/verify/verify_run.hpp"

namespace unravel::tool {

namespace {

constexpr double turning = 3.0;  // rad/s of the sheet that spins

const std::vector<std::array<int, 2>> flying_sheets{{9, 9}, {17, 9}, {33, 33}};

std::string sheet(std::array<int, 2> grid, double steps, const std::string& cloth, const std::string& rest) {
    return fmt::format(
        "{}[clip]\nduration = 5\nfps = 10\n[cloth]\nparticles = [{}, {}]\nsize = [0.5, 0.5]\ndensity = "
        "0.2\n{}"
        "\n[solver]\nstep = \"1/{}\"\n",
        rest, grid[0], grid[1], cloth, steps);
}

Vec3 momentum_of(const Simulation& simulation) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < simulation.model.size(); ++p)
        sum += simulation.model.mass[p] * simulation.state.v[p];
    return sum;
}

Vec3 spin_of(const Simulation& simulation) {
    const Vec3 centre = centre_of(simulation);
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < simulation.model.size(); ++p) {
        const Vec3 arm = simulation.state.x[p] - centre;
        sum += simulation.model.mass[p] * arm.cross(simulation.state.v[p]);
    }
    return sum;
}

}  // namespace

VerifyCase::Result verify_fall(bool fast) {
    VerifyCase::Result result;
    const auto measure = [](std::array<int, 2> grid, double steps) {
        Simulation simulation = verify_simulation(sheet(grid, steps, "", ""));
        run_until(simulation, 0.5);
        return -centre_of(simulation).y();
    };
    add_lines({flying_sheets, common_steps}, fast, "", 0.5 * gravity * 0.25, 0.01, measure, result.lines);
    return result;
}

VerifyCase::Result verify_momentum(bool fast) {
    VerifyCase::Result result;
    const auto measure = [](std::array<int, 2> grid, double steps) {
        Simulation simulation = verify_simulation(sheet(
            grid, steps, "velocity = [1, 0, 0]\nplaced_scale = [1.05, 1.02]\n", "gravity = [0, 0, 0]\n"));
        double mass = 0;
        for (const double m : simulation.model.mass) mass += m;
        run_until(simulation, 0.5);
        return momentum_of(simulation).x() / mass;
    };
    add_lines({flying_sheets, common_steps}, fast, "", 1.0, 1e-4, measure, result.lines);
    return result;
}

VerifyCase::Result verify_terminal(bool fast) {
    VerifyCase::Result result;
    const auto measure = [](std::array<int, 2> grid, double steps) {
        Simulation simulation =
            verify_simulation(sheet(grid, steps, "", "") + "[wind]\ndensity = 1.2\ndrag = 1.3\n");
        run_until(simulation, 2.0);
        double mass = 0;
        for (const double m : simulation.model.mass) mass += m;
        return -momentum_of(simulation).y() / mass;
    };
    add_lines({flying_sheets, common_steps}, fast, "", std::sqrt(2 * 0.2 * gravity / (1.2 * 1.3)), 0.01,
              measure, result.lines);
    return result;
}

VerifyCase::Result verify_slack(bool fast) {
    VerifyCase::Result result;
    // By explicit steps of 1/12800 s on the grid of 21 x 21.
    for (const auto& [time, expected] : {std::pair(0.1, 40.18), std::pair(0.5, 304.3)}) {
        const auto measure = [&, until = time](std::array<int, 2> grid, double steps) {
            Simulation simulation = verify_simulation(fmt::format(
                "[clip]\nduration = 0.6\nfps = 50\n[cloth]\nparticles = [{}, {}]\nsize = [1, 1]\nrotation = "
                "[90, 0, "
                "0]\ndensity = 0.1\nmaterial = {{ preset = \"silk\" }}\n[[cloth.pin]]\ncorner = [\"u0v0\"]\n"
                "[wind]\n[solver]\nstep = \"1/{}\"\n",
                grid[0], grid[1], steps));
            const double start = centre_of(simulation).y();
            run_until(simulation, until);
            return 1000 * (start - centre_of(simulation).y());
        };
        add_lines({{{21, 21}}, {400, 800, 1600}}, fast, fmt::format("t = {} s", time), expected, 0.05,
                  measure, result.lines);
    }
    return result;
}

VerifyCase::Result verify_spin(bool fast) {
    VerifyCase::Result result;
    for (const double steps : common_steps) {
        const auto measure = [](std::array<int, 2> grid, double rate) {
            Simulation simulation = verify_simulation(
                sheet(grid, rate, "material = { stretch = 2000, shear = 500, stretch_damping = 0.02 }\n",
                      "gravity = [0, 0, 0]\n"));
            const Vec3 centre = centre_of(simulation);
            for (std::size_t p = 0; p < simulation.model.size(); ++p)
                simulation.state.v[p] = turning * Vec3::UnitY().cross(simulation.state.x[p] - centre);
            // The motion is part of the start, as the guard has to know it.
            simulation.guard = make_guard(simulation.model, simulation.state, 1 / rate);
            const double start = spin_of(simulation).norm();
            run_until(simulation, 1.0);
            return spin_of(simulation).norm() / start;
        };
        add_lines({flying_sheets, {steps}}, fast, "implicit stretch", std::exp(-turning * turning / steps),
                  0.01, measure, result.lines);
        if (fast) break;
    }
    return result;
}

}  // namespace unravel::tool
