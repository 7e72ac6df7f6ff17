#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tool/study/verify/verify_cases.hpp"
#include "tool/study/verify/verify_run.hpp"

namespace unravel::tool {

namespace {

const std::vector<std::array<int, 2>> sliding_sheets{{9, 9}, {9, 17}, {21, 21}};

// A sheet that lies on a slope of `angle` [rad] and moves down along it at `speed`.
Simulation on_slope(std::array<int, 2> grid, double steps, double angle, double friction, double speed) {
    const double degrees = angle * 180 / std::numbers::pi, offset = 0.004;
    return verify_simulation(fmt::format(
        "[clip]\nduration = 5\nfps = 10\n[cloth]\nparticles = [{}, {}]\nsize = [0.3, 0.3]\ndensity = 0.2\n"
        "center = [{}, {}, 0]\nrotation = [0, 0, {}]\nvelocity = [{}, {}, 0]\n"
        "material = {{ stretch = 500, shear = 50 }}\n"
        "[[solid]]\nshape = \"plane\"\nrotation = [0, 0, {}]\nfriction = {{ static = {}, kinetic "
        "= {} }}\noffset = {}\n[solver]\nstep = "
        "\"1/{}\"\n",
        grid[0], grid[1], offset * std::sin(angle), offset * std::cos(angle), -degrees,
        speed * std::cos(angle), -speed * std::sin(angle), -degrees, friction, friction, offset, steps));
}

double way_of(Simulation& simulation, double time) {
    const Vec3 start = centre_of(simulation);
    run_until(simulation, time);
    return (centre_of(simulation) - start).norm();
}

// A tape laid half round a cylinder, a mass on each end: the ratio of the masses is that of the tensions.
bool slips(std::array<int, 2> grid, double steps, double radius, double friction, double ratio) {
    const double round = std::numbers::pi * (radius + 0.004), hanging = 0.15, length = round + 2 * hanging;
    const double end = 0.5 / (grid[1] - 1);
    // Density of the last rows: the tape's own weight is a two hundredth of theirs.
    const double light = 200.0;
    Simulation simulation = verify_simulation(fmt::format(
        "[clip]\nduration = 5\nfps = 10\n[cloth]\nparticles = [{}, {}]\nsize = [0.02, {}]\ncenter = [0, 1, "
        "0]\ndensity = 0.02\n"
        "material = {{ stretch = 2000, shear = 20, bend = 1e-7, stretch_damping = 1 }}\n"
        "[[cloth.region]]\nbox = [0, 0, 1, {}]\ndensity = {}\n[[cloth.region]]\nbox = [0, {}, 1, 1]\ndensity "
        "= {}\n"
        "[[solid]]\nshape = \"cylinder\"\nradius = {}\nheight = 0.2\nrotation = [0, 0, 90]\nfriction = {{ "
        "static = {}, "
        "kinetic = {} }}\n"
        "[solver]\nstep = \"1/{}\"\ntolerance = 1e-5\n",
        grid[0], grid[1], length, end, light, 1 - end, light * ratio, radius, friction, friction, steps));
    // From above the cylinder, where the scene has it, to around it. Its axis is x.
    const ClothPatch& patch = simulation.model.cloths[0];
    for (int j = 0; j < patch.particles[1]; ++j) {
        const double s = length * j / patch.cells_v() - 0.5 * length, r = radius + 0.004;
        for (int i = 0; i < patch.particles[0]; ++i) {
            Vec3& x = simulation.state.x[patch.at(i, j)];
            const double angle = std::clamp(s / r, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi);
            const double down = std::abs(s) - 0.5 * round;
            x.z() = r * std::sin(angle);
            x.y() = r * std::cos(angle) - std::max(down, 0.0);
        }
    }
    const auto heavy = static_cast<std::size_t>(patch.at(0, patch.particles[1] - 1));
    run_until(simulation, 0.2);  // until it is taut
    const double start = simulation.state.x[heavy].y();
    run_until(simulation, 1.2);
    return start - simulation.state.x[heavy].y() > 0.01;
}

}  // namespace

VerifyCase::Result verify_block(bool fast) {
    VerifyCase::Result result;
    for (const double friction : {0.3, 0.6}) {
        const auto measure = [&](std::array<int, 2> grid, double steps) {
            Simulation simulation = on_slope(grid, steps, 0, friction, 1.5);
            return way_of(simulation, 1.5);
        };
        add_lines({sliding_sheets, common_steps}, fast, fmt::format("μ = {}", friction),
                  1.5 * 1.5 / (2 * friction * gravity), 0.05, measure, result.lines);
    }
    return result;
}

VerifyCase::Result verify_incline(bool fast) {
    VerifyCase::Result result;
    constexpr double friction = 0.4;
    for (const double times : {0.95, 1.5}) {
        const double angle = std::atan(times * friction);
        const auto measure = [&](std::array<int, 2> grid, double steps) {
            Simulation simulation = on_slope(grid, steps, angle, friction, 0);
            return way_of(simulation, 0.5);
        };
        const double way = 0.5 * gravity * std::max(std::sin(angle) - friction * std::cos(angle), 0.0) * 0.25;
        const std::size_t first = result.lines.size();
        add_lines({sliding_sheets, common_steps}, fast, fmt::format("tan θ = {} μ", times), way, 0.05,
                  measure, result.lines);
        // At rest, to a tenth of a millimetre.
        for (std::size_t k = first; k < result.lines.size(); ++k)
            result.lines[k].tolerance = std::max(result.lines[k].tolerance, 1e-4);
    }
    return result;
}

VerifyCase::Result verify_capstan(bool fast) {
    VerifyCase::Result result;
    const std::vector<double> frictions = fast ? std::vector{0.3} : std::vector{0.1, 0.3, 0.5};
    const std::vector<double> radii = fast ? std::vector{0.05} : std::vector{0.05, 0.1};
    for (const double radius : radii) {
        for (const double friction : frictions) {
            for (const double share : {0.95, 1.05}) {
                const auto measure = [&](std::array<int, 2> grid, double steps) {
                    const double ratio = share * std::exp(friction * std::numbers::pi);
                    return slips(grid, steps, radius, friction, ratio) ? 1.0 : 0.0;
                };
                const std::size_t first = result.lines.size();
                add_lines({{{3, 61}, {3, 121}, {5, 61}}, {400, 1000, 2000}}, fast,
                          fmt::format("μ = {}, R = {} m, {} of the limit", friction, radius, share),
                          share > 1 ? 1.0 : 0.0, 0, measure, result.lines);
                for (std::size_t k = first; k < result.lines.size(); ++k) result.lines[k].tolerance = 0.5;
            }
        }
    }
    return result;
}

}  // namespace unravel::tool
