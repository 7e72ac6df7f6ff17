#pragma once

#include <chrono>

#include "sim/run/simulate.hpp"
#include "sim/step/trace.hpp"
#include "tool/base/names.hpp"
#include "tool/bench/folded_system.hpp"
#include "tool/bench/speed.hpp"

namespace unravel::tool {

/// What is left of a budget.
class Allowance {
public:
    explicit Allowance(double seconds) : seconds_(seconds) {}
    double left() const {
        return seconds_ - std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double seconds_;
};

/// A cloth in motion: the state from which every way to step starts, and the linear system of its next step,
/// which every way to solve is given.
class MeasuredProblem {
public:
    /// Simulates the scene until `start` seconds on `threads` threads.
    MeasuredProblem(const Scene& scene, double start, int threads);
    MeasuredProblem(const MeasuredProblem&) = delete;  // parts of it point at each other
    MeasuredProblem& operator=(const MeasuredProblem&) = delete;

    const Simulation& simulation() const { return simulation_; }
    double h() const { return h_; }
    /// Of the step that led to the state.
    const StepReport& report() const { return report_; }

    /// Seconds and report of each of `count` steps from the state, after one that is not counted.
    struct Steps {
        double seconds = 0;
        StageTimes stages;
        double substeps = 0, iterations = 0;
    };
    Steps run_steps(const StepKind& kind, int count);

    /// Computes one step by the scene's own integrator and keeps its system for what follows.
    void capture(int threads);
    const Components& components() const { return components_; }
    const Constraints& constraints() const { return constraints_; }
    const StepCouplings& couplings() const { return couplings_; }
    std::uint32_t constrained() const { return constrained_; }

    struct Solve {
        double seconds = 0, set_up = 0, iterations = 0;
        std::uint64_t rvm = 0;
    };
    /// Assembles and solves the captured system.
    Solve solve(const SolveOptions& options, int threads);
    /// The same of its largest component alone.
    Solve solve_largest(const SolveOptions& options, int threads);
    /// Rows multiplied by each component in the last solve().
    const std::vector<ComponentSolve>& solves() const { return solves_; }
    /// Δv of the last solve(), by particle [m/s].
    std::vector<Vec3> solution() const;
    /// The largest component's grid in the last solve(); nothing where it has none.
    const GridSystem* grid() const;
    /// Block rows and off-diagonal blocks of the system by rows.
    std::pair<double, double> blocks() const { return {rows_, entries_}; }

    FoldedSystem folded();

private:
    StepSystem system(const Components& components) const;
    Solve solve(const Components& components, const SolveOptions& options, int threads);

    Simulation simulation_;  // its state is where every step starts
    double h_ = 0;
    StepReport report_;
    std::vector<Vec3> guess_;
    // The captured system, and the memory of solving it.
    StepCouplings couplings_;
    Load load_;
    double stage_h_ = 0;
    Components components_, largest_;
    Constraints constraints_;
    GridSolves grids_;
    System rows_system_;
    SolveWorkspace solve_;
    std::vector<ComponentSolve> solves_;
    std::uint32_t constrained_ = 0;
    double rows_ = 0, entries_ = 0;
};

}  // namespace unravel::tool
