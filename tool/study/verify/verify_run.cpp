#include "tool/study/verify/verify_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "sim/scene_file/load.hpp"

namespace unravel::tool {

bool VerifyLine::holds() const {
    return failure.empty() && std::abs(measured - expected) <= tolerance;
}

int VerifyOutcome::wrong() const {
    int count = 0;
    for (const VerifyLine& line : result.lines) count += !line.holds();
    return count;
}

VerifyOutcome run_verify_case(const VerifyCase& of, bool fast) {
    const auto start = std::chrono::steady_clock::now();
    VerifyOutcome outcome{&of, of.run(fast)};
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return outcome;
}

void add_lines(const VerifyLadder& ladder, bool fast, const std::string& of, double expected,
               double tolerance, const std::function<double(std::array<int, 2>, double)>& measure,
               std::vector<VerifyLine>& lines) {
    for (const std::array<int, 2>& grid : ladder.grids) {
        for (const double steps : ladder.steps) {
            VerifyLine line;
            line.of = of;
            line.grid = fmt::format("{} x {}", grid[0], grid[1]);
            line.step = 1 / steps;
            line.expected = expected;
            line.tolerance = tolerance * std::abs(expected);
            try {
                line.measured = measure(grid, steps);
            } catch (const std::exception& error) {
                line.failure = error.what();
                line.measured = std::numeric_limits<double>::quiet_NaN();
            }
            lines.push_back(line);
            if (fast) return;
        }
    }
}

Simulation verify_simulation(const std::string& scene) {
    return start_simulation(parse_scene(scene, "verify.toml"));
}

void run_until(Simulation& simulation, double time) {
    while (simulation.state.t < time - 1e-9) next_step(simulation);
}

Vec3 centre_of(const Simulation& simulation) {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (std::size_t p = 0; p < simulation.model.size(); ++p) {
        sum += simulation.model.mass[p] * simulation.state.x[p];
        mass += simulation.model.mass[p];
    }
    return sum / mass;
}

double spring_energy(Simulation& simulation) {
    StepReport report;
    MeasureWorkspace scratch;
    ForceMemory forces;
    prepare_terms(simulation.model, 0, forces);
    measure(simulation.model, forces, simulation.state, scratch, report);
    double height = 0;
    for (std::size_t p = 0; p < simulation.model.size(); ++p)
        height -= simulation.model.mass[p] * simulation.model.gravity.dot(simulation.state.x[p]);
    return report.potential - height;
}

}  // namespace unravel::tool
