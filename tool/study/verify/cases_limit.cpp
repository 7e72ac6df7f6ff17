#include <fmt/format.h>

#include <cmath>

#include "sim/forces/extension.hpp"
#include "tool/study/verify/verify_cases.hpp"
#include "tool/study/verify/verify_run.hpp"

namespace unravel::tool {

namespace {

constexpr double limit_step = 1.0 / 600;

// A sheet, taut by so little that threads resist next to nothing across, between four pinned borders, or a
// chain between two ends, with a little noise in it, whose inner springs have the given κ for single explicit
// steps of 1/600 s.
bool grows(std::array<int, 2> grid, bool with_shear, double kappa) {
    const double cell = 0.02, mass = 0.2 * cell * cell;
    const double stiffness = kappa * mass / (limit_step * limit_step);  // of a spring
    const bool chain = grid[1] == 1;
    // A chain's spring stands for a strip one cell wide; a sheet's threads have what its diagonals leave.
    const double shear = with_shear ? 0.5 * stiffness : 0.0;  // diagonals of square cells have 2 G
    const double stretch = stiffness + (with_shear ? 2 * shear : 0.0);
    Simulation simulation = verify_simulation(fmt::format(
        "gravity = [0, 0, 0]\n[clip]\nduration = 5\nfps = 10\n[cloth]\nparticles = [{}, {}]\nsize = [{}, "
        "{}]\n"
        "placed_scale = [1.02, 1.02]\nmaterial = {{ stretch = {}, shear = {}, bend = 0, stretch_damping = 0, "
        "shear_damping = 0 }}\n{}[solver]\nintegrator = \"explicit\"\nstep = \"1/600\"\n",
        grid[0], grid[1], cell * (grid[0] - 1), chain ? cell : cell * (grid[1] - 1), stretch, shear,
        chain ? "[[cloth.pin]]\ncorner = [\"u0v0\", \"u1v0\"]\n"
              : "[[cloth.pin]]\nedge = [\"u0\", \"u1\", \"v0\", \"v1\"]\n"));
    std::vector<char> held(simulation.model.size(), 0);
    for (const PinnedGroup& pin : simulation.model.pins)
        for (const std::uint32_t p : pin.particles) held[p] = 1;
    for (std::size_t p = 0; p < simulation.model.size(); ++p) {
        const auto side = [&](std::size_t k) {
            return std::sin(12.9898 * static_cast<double>(3 * p + k + 1));
        };
        if (held[p] == 0) simulation.state.v[p] = 1e-4 * Vec3(side(0), side(1), side(2));
    }
    const auto motion = [&] {
        double sum = 0;
        for (const Vec3& v : simulation.state.v) sum += v.squaredNorm();
        return sum;
    };
    simulation.options.measure = false;  // the guard would stop what this looks for
    const double start = motion();
    for (int k = 0; k < 600; ++k) {
        next_step(simulation);
        if (!(motion() < 1e4 * start)) return true;
    }
    return false;
}

double critical_kappa(std::array<int, 2> grid, bool with_shear) {
    double low = 0.05, high = 3;
    for (int k = 0; k < 12; ++k) {
        const double middle = 0.5 * (low + high);
        (grows(grid, with_shear, middle) ? high : low) = middle;
    }
    return low;
}

}  // namespace

VerifyCase::Result verify_kappa(bool fast) {
    VerifyCase::Result result;
    struct Kind {
        const char* name;
        std::vector<std::array<int, 2>> grids;
        bool with_shear;
        double expected;
    };
    const std::vector<Kind> kinds{{"chain", {{11, 1}, {21, 1}, {41, 1}}, false, 1.0},
                                  {"sheet without shear", {{11, 11}, {21, 21}}, false, 1.0},
                                  {"sheet with shear", {{11, 11}, {21, 21}}, true, 0.5}};
    for (const Kind& kind : kinds) {
        for (const std::array<int, 2>& grid : kind.grids) {
            VerifyLine line;
            line.of = kind.name;
            line.grid = fmt::format("{} x {}", grid[0], grid[1]);
            line.expected = kind.expected;
            line.tolerance = 0.05 * kind.expected;
            try {
                line.measured = critical_kappa(grid, kind.with_shear);
            } catch (const std::exception& error) {
                line.failure = error.what();
            }
            result.lines.push_back(line);
            if (fast) break;
        }
    }
    return result;
}

}  // namespace unravel::tool
