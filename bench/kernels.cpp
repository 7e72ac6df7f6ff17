// Google Benchmark of what a step is made of, by number of particles: what `unravel bench` measures from
// outside, alone and repeated until it is steady. cmake --preset release -DUNRAVEL_BUILD_BENCH=ON, then
// unravel_kernels.

#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "source_dir.hpp"
#include "tool/bench/measured_problem.hpp"
#include "tool/bench/sized_scene.hpp"

namespace unravel {

namespace {

// A hanging sheet in motion, simulated once for each size.
MeasuredProblem& sheet(std::int64_t particles) {
    static std::map<std::int64_t, std::unique_ptr<MeasuredProblem>> made;
    std::unique_ptr<MeasuredProblem>& problem = made[particles];
    if (!problem) {
        const Scene scene =
            scene_of_size(UNRAVEL_SOURCE_DIR "/scenes/hang.toml", {}, static_cast<std::size_t>(particles));
        problem = std::make_unique<MeasuredProblem>(scene, 0.5, 1);
        problem->capture(1);
    }
    return *problem;
}

void per_particle(benchmark::State& state, double particles) {
    state.counters["ns/particle"] = benchmark::Counter(
        1e-9 * particles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void components(benchmark::State& state) {
    MeasuredProblem& problem = sheet(state.range(0));
    std::vector<std::uint32_t> parent;
    Components out;
    for (auto _ : state)
        find_components(problem.simulation().model.size(), problem.couplings(), problem.constraints(), parent,
                        out);
    per_particle(state, static_cast<double>(problem.simulation().model.size()));
}

void solve(benchmark::State& state, Preconditioner kind) {
    MeasuredProblem& problem = sheet(state.range(0));
    double iterations = 0;
    for (auto _ : state) iterations = problem.solve({kind, 1e-3, 2000}, 1).iterations;
    state.counters["iterations"] = iterations;
    per_particle(state, static_cast<double>(problem.simulation().model.size()));
}

void step(benchmark::State& state, Integrator integrator) {
    MeasuredProblem& problem = sheet(state.range(0));
    const StepKind kind{"", integrator, Preconditioner::automatic, true, 1};
    for (auto _ : state) state.SetIterationTime(problem.run_steps(kind, 3).seconds);
    per_particle(state, static_cast<double>(problem.simulation().model.size()));
}

}  // namespace

}  // namespace unravel

using namespace unravel;
using namespace unravel::tool;

BENCHMARK(components)->Arg(10000)->Arg(40000);
BENCHMARK_CAPTURE(solve, stencil_block, Preconditioner::stencil_block)->Arg(10000)->Arg(40000);
BENCHMARK_CAPTURE(solve, multigrid, Preconditioner::multigrid)->Arg(10000)->Arg(40000);
BENCHMARK_CAPTURE(solve, constrained_block, Preconditioner::constrained_block)->Arg(10000);
BENCHMARK_CAPTURE(step, adaptive_imex, Integrator::adaptive_imex)->Arg(10000)->Arg(40000)->UseManualTime();
BENCHMARK_CAPTURE(step, explicit_sweep, Integrator::explicit_)->Arg(10000)->Arg(40000)->UseManualTime();
BENCHMARK_MAIN();
