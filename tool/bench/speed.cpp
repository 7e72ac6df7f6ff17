#include "tool/bench/speed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool/base/machine.hpp"
#include "tool/bench/measure_solves.hpp"
#include "tool/bench/measure_steps.hpp"
#include "tool/bench/measured_problem.hpp"
#include "tool/bench/memory.hpp"
#include "tool/bench/peers.hpp"
#include "tool/bench/sized_scene.hpp"
#include "tool/bench/triad.hpp"

namespace unravel::tool {

namespace {

// Into the clip at which everything is measured: the hanging sheet is near the bottom of its first swing.
constexpr double settle = 0.5;
// Nodes of a grid that one of its solver's tasks takes (sim/kernels/grid_system.hpp).
constexpr int nodes_per_task = 2048;
// A grid of no more nodes is the last of a multigrid (sim/kernels/line_multigrid.cpp).
constexpr int coarsest_nodes = 32;

int depth_of(int columns, int rows) {
    int depth = 1;
    for (; columns * rows > coarsest_nodes; ++depth) {
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
    }
    return depth;
}

// The largest component's share of the solve, its serial share, the others by what they multiplied.
void account_solve(MeasuredProblem& problem, const SizeRecord& record, double seconds, int threads,
                   Account& account) {
    const SolveOptions options{Preconditioner::automatic, problem.simulation().options.solve.tolerance,
                               problem.simulation().options.solve.max_iterations};
    problem.solve(options, 1);
    const std::vector<ComponentSolve> solves = problem.solves();
    const Components& components = problem.components();
    std::array<std::vector<double>, 3> times;  // the largest on one thread, on all; all of them on one
    for (int run = 0; run < 4; ++run) {
        const std::array<MeasuredProblem::Solve, 3> solved{problem.solve_largest(options, 1),
                                                           problem.solve_largest(options, threads),
                                                           problem.solve(options, 1)};
        for (std::size_t k = 0; run > 0 && k < solved.size(); ++k)
            times[k].push_back(solved[k].seconds - solved[k].set_up);
    }
    const double alone = spread_of(times[0]).median, shared = spread_of(times[1]).median,
                 all = std::max(spread_of(times[2]).median, alone);
    account.serial = serial_share(alone, shared, threads);
    std::size_t largest = 0;
    double others = 0;
    for (std::size_t c = 0; c < solves.size(); ++c) {
        if (components.size(c) > components.size(largest)) largest = c;
        others += static_cast<double>(solves[c].rvm);
    }
    if (solves.empty()) return;
    others -= static_cast<double>(solves[largest].rvm);
    account.components.push_back(all > 0 ? seconds * alone / all : seconds);
    for (std::size_t c = 0; c < solves.size() && others > 0; ++c) {
        if (c != largest)
            account.components.push_back((seconds - account.components.front()) *
                                         static_cast<double>(solves[c].rvm) / others);
    }
    problem.solve(options, 1);
    const GridSystem* grid = problem.grid();
    const SolveRecord *chosen = record.solve_of("auto", 1), *cycles = record.solve_of("multigrid", 1);
    const bool multigrid = grid && chosen && cycles && chosen->iterations <= cycles->iterations;
    if (grid) {
        account.levels =
            levels_of_grid(grid->grid.nu, grid->grid.nv,
                           multigrid ? depth_of(grid->grid.nu, grid->grid.nv) : 1, nodes_per_task);
    } else {
        const double chunks = std::ceil(components.largest() / static_cast<double>(chunk_size));
        account.levels = {{1.0, std::max(1, static_cast<int>(chunks))}};
    }
}

Account account_of(MeasuredProblem& problem, const SizeRecord& record, int threads) {
    Account account;
    const StepRecord *one = record.step_of(own_step, 1), *all = record.step_of(own_step, threads);
    if (!one || !all) return account;
    for (const auto& [name, slot] : step_stages) {
        if (slot == &StageTimes::solve || one->stages.*slot <= 0) continue;
        account.stages.push_back(
            {name, one->stages.*slot, serial_share(one->stages.*slot, all->stages.*slot, threads)});
    }
    account_solve(problem, record, one->stages.solve, threads, account);
    return account;
}

SizeRecord measure_size(const SpeedPlan& plan, const SpeedBench& bench, std::size_t n, double seconds) {
    const Allowance begun(seconds);
    const Scene scene = scene_of_size(plan.scene, plan.overrides, n);
    SizeRecord record;
    record.grid = scene.cloths.front().particles;
    record.particles = static_cast<double>(record.grid[0]) * record.grid[1];
    record.start = std::min(settle, 0.5 * scene.clip.duration);
    plan.tell(fmt::format("{:.0f} particles: simulating {:.2g} s", record.particles, record.start));
    const MemoryWatch memory;
    MeasuredProblem problem(scene, record.start, plan.threads);
    record.memory = account_memory(problem.simulation(), memory.peak());
    record.step = problem.h();
    record.max_strain = problem.report().max_strain;
    record.p99_strain = problem.report().p99_strain;

    // A large problem takes long to get going, and is then to be measured all the same.
    const Allowance allowance(std::max(begun.left(), 0.5 * seconds));
    plan.tell(fmt::format("{:.0f} particles: steps", record.particles));
    measure_steps(problem, plan, bench, allowance, record);

    plan.tell(fmt::format("{:.0f} particles: solves", record.particles));
    problem.capture(plan.threads);
    record.components = static_cast<std::uint32_t>(problem.components().count());
    record.largest = problem.components().largest();
    record.constrained = problem.constrained();
    record.rows = problem.components().start.back();
    measure_solves(problem, plan, bench, allowance, record);
    record.account = account_of(problem, record, plan.threads);
    return record;
}

}  // namespace

const StepRecord* SizeRecord::step_of(const std::string& name, int threads) const {
    const auto found = std::find_if(steps.begin(), steps.end(), [&](const StepRecord& s) {
        return s.name == name && s.threads == threads && s.seconds.runs > 0;
    });
    return found == steps.end() ? nullptr : &*found;
}

const SolveRecord* SizeRecord::solve_of(const std::string& name, int threads) const {
    const auto found = std::find_if(solves.begin(), solves.end(), [&](const SolveRecord& s) {
        return s.name == name && s.threads == threads && s.seconds.runs > 0;
    });
    return found == solves.end() ? nullptr : &*found;
}

PowerLaw step_law(const SpeedBench& bench, double StageTimes::*stage, int threads, double from) {
    std::vector<Measured> points;
    for (const SizeRecord& size : bench.sizes) {
        if (const StepRecord* s = size.step_of(own_step, threads))
            points.push_back({size.particles, stage ? s->stages.*stage : s->seconds.median});
    }
    return fit_power(points, from);
}

SpeedBench measure_speed(const SpeedPlan& plan) {
    const Allowance allowance(plan.seconds);
    SpeedBench bench;
    bench.processor = processor_name();
    bench.threads = plan.threads;
    bench.cholmod_missing = cholmod_missing();
    // A scene that can't be refined is told of before anything is measured.
    const Scene scene = scene_of_size(plan.scene, plan.overrides, plan.sizes.front());
    bench.scene = scene.name;
    plan.tell("triad");
    bench.memory_triad = {triad(triad_memory, 1), triad(triad_memory, plan.threads)};
    bench.cache_triad = {triad(triad_cache, 1), triad(triad_cache, plan.threads)};
    double all = 0;
    for (const std::size_t n : plan.sizes) all += static_cast<double>(n);
    for (const std::size_t n : plan.sizes) {
        const double share = allowance.left() * static_cast<double>(n) / all;
        bench.sizes.push_back(measure_size(plan, bench, n, share));
        all -= static_cast<double>(n);
    }
    bench.seconds = plan.seconds - allowance.left();
    return bench;
}

}  // namespace unravel::tool
