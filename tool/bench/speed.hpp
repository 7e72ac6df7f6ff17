#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/report.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/base/spread.hpp"
#include "tool/bench/account.hpp"
#include "tool/bench/fit.hpp"

namespace unravel::tool {

/// A way to step, by name: "adaptive-imex/auto", "explicit".
struct StepKind {
    std::string name;
    Integrator integrator = Integrator::adaptive_imex;
    Preconditioner preconditioner = Preconditioner::automatic;
    bool decompose = true;
    int threads = 1;
};

/// What it took, per step, from the same state as all others.
struct StepRecord {
    std::string name;
    int threads = 1;
    Spread seconds;     ///< no run: left out
    StageTimes stages;  ///< s, of the run of median time
    double substeps = 1;
    double iterations = 0;  ///< of the component that took most, mean
    std::string left_out;   ///< why; empty: measured
};

/// What one way to solve took for the very same linear system as all others, to the tolerance of 1e-3.
struct SolveRecord {
    std::string name;
    int threads = 1;
    bool ours = true;
    Spread seconds;         ///< assembly (ours) and set-up included
    double set_up = 0;      ///< s, of it: ours: assembly alone
    double iterations = 0;  ///< of the component that took most; 0: direct
    double residual = 0;    ///< reached, in the norm of our stopping rule
    double row_iteration = std::numeric_limits<double>::quiet_NaN();  ///< s per block row and CG iteration
    double row_bytes = std::numeric_limits<double>::quiet_NaN();  ///< that one must move at least, if nothing
                                                                  ///< stayed in a cache
    std::string left_out;
};

/// What a problem keeps in memory, bytes per particle.
struct MemoryRecord {
    /// Growth of resident memory from before the model was built, at its highest; NaN where the problem is
    /// too small to tell.
    double peak = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::pair<std::string, double>> arrays;  ///< named, as used; "rest": what is not named
};

struct SizeRecord {
    double particles = 0;
    std::array<int, 2> grid{0, 0};
    double rows = 0;  ///< of the system that was solved
    std::uint32_t components = 0, largest = 0, constrained = 0;
    double step = 0, start = 0;             ///< s: h, and the time of the state that all begin at
    double max_strain = 0, p99_strain = 0;  ///< of stretch springs in that state
    std::vector<StepRecord> steps;
    std::vector<SolveRecord> solves;
    MemoryRecord memory;
    Account account;

    const StepRecord* step_of(const std::string& name, int threads) const;
    const SolveRecord* solve_of(const std::string& name, int threads) const;
};

/// A goal, and what was reached.
struct Goal {
    std::string what, bound, reached;
    int met = -1;  ///< 1: yes, 0: no, −1: not measured here
};

struct SpeedBench {
    std::string scene, processor;
    int threads = 1;                                      ///< all of them
    std::array<double, 2> memory_triad{}, cache_triad{};  ///< GB/s on one thread, on all
    std::vector<SizeRecord> sizes;
    double seconds = 0;  ///< that all of it took
    std::string cholmod_missing;
};

struct SpeedPlan {
    std::filesystem::path scene;
    std::vector<std::string> overrides;
    std::vector<std::size_t> sizes;
    int threads = 1;
    double seconds = 600;  ///< budget: repeats, then slow rivals are cut
    int repeats = 5;
    std::function<void(const std::string&)> tell;  ///< what is being done, for people
};

/// Measures everything. Throws what loading and simulating throws.
SpeedBench measure_speed(const SpeedPlan& plan);

/// The name of the step as users get it: the scene's own integrator with `preconditioner = "auto"`.
inline constexpr const char* own_step = "step";

/// Exponent of a stage, or of the whole step where `stage` is null, of `own_step` on `threads` threads.
PowerLaw step_law(const SpeedBench& bench, double StageTimes::*stage, int threads, double from = 0);

std::vector<Goal> judge_goals(const SpeedBench& bench);

}  // namespace unravel::tool
