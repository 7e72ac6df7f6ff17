#include "tool/bench/measure_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace unravel::tool {

namespace {

// Share of a size's allowance that steps may take; the rest is for solves.
constexpr double steps_share = 0.45;

std::vector<StepKind> kinds_of(Integrator own, const std::vector<int>& threads) {
    std::vector<StepKind> kinds;
    for (const int t : threads) kinds.push_back({own_step, own, Preconditioner::automatic, true, t});
    const int all = threads.back();
    const auto on_one_and_all = [&](StepKind kind) {
        kind.threads = 1;
        kinds.push_back(kind);
        if (all == 1) return;
        kind.threads = all;
        kinds.push_back(kind);
    };
    on_one_and_all({"whole", own, Preconditioner::automatic, false});
    on_one_and_all({"blocks", own, Preconditioner::stencil_block, true});
    on_one_and_all({"multigrid", own, Preconditioner::multigrid, true});
    on_one_and_all({"explicit", Integrator::explicit_, Preconditioner::automatic, true});
    on_one_and_all({"integrator auto", Integrator::automatic, Preconditioner::automatic, true});
    on_one_and_all({"plain, whole", own, Preconditioner::constrained_block, false});
    on_one_and_all({"plain", own, Preconditioner::constrained_block, true});
    return kinds;
}

// What a way to step would take at most, from what it took for the largest smaller problem.
double expected(const SpeedBench& smaller, const StepKind& kind, double particles) {
    for (auto size = smaller.sizes.rbegin(); size != smaller.sizes.rend(); ++size) {
        if (const StepRecord* s = size->step_of(kind.name, kind.threads))
            return s->seconds.median * std::pow(particles / size->particles, 1.6);
    }
    return 0;
}

}  // namespace

std::vector<int> thread_counts(int all) {
    std::vector<int> counts;
    for (int t = 1; t < all; t *= 2) counts.push_back(t);
    counts.push_back(all);
    return counts;
}

void measure_steps(MeasuredProblem& problem, const SpeedPlan& plan, const SpeedBench& smaller,
                   const Allowance& allowance, SizeRecord& record) {
    const std::vector<StepKind> kinds =
        kinds_of(problem.simulation().options.integrator, thread_counts(plan.threads));
    const int count = record.particles < 3e4 ? 5 : record.particles < 3e5 ? 3 : 2;
    const double until = (1 - steps_share) * allowance.left();
    std::vector<std::vector<MeasuredProblem::Steps>> runs(kinds.size());
    std::vector<std::string> left_out(kinds.size());
    for (int run = 0; run < plan.repeats; ++run) {
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            if (!left_out[k].empty()) continue;
            const double each =
                run > 0 ? runs[k].front().seconds : expected(smaller, kinds[k], record.particles);
            const bool fits = (count + 1) * each < allowance.left() - until;
            if (run == 0 && !fits && kinds[k].name != own_step)
                left_out[k] = fmt::format("about {:.3g} s a step: beyond the budget", each);
            if (fits || (run == 0 && left_out[k].empty()))
                runs[k].push_back(problem.run_steps(kinds[k], count));
        }
    }
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        StepRecord step;
        step.name = kinds[k].name;
        step.threads = kinds[k].threads;
        step.left_out = left_out[k];
        if (!runs[k].empty()) {
            std::sort(runs[k].begin(), runs[k].end(),
                      [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
            std::vector<double> seconds;
            for (const MeasuredProblem::Steps& r : runs[k]) seconds.push_back(r.seconds);
            step.seconds = spread_of(std::move(seconds));
            const MeasuredProblem::Steps& middle = runs[k][runs[k].size() / 2];
            step.stages = middle.stages;
            step.substeps = middle.substeps;
            step.iterations = middle.iterations;
        }
        record.steps.push_back(std::move(step));
    }
}

}  // namespace unravel::tool
