// What the design asks of speed (its section 11), beside what was measured.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool/bench/speed_report.hpp"

namespace unravel::tool {

namespace {

// The triad of the machine on which absolute times were set as goals, GB/s on one thread and on two.
constexpr std::array<double, 2> goal_triad{26, 32};
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// The size within a fifth of n.
const SizeRecord* near(const SpeedBench& bench, double n) {
    for (const SizeRecord& size : bench.sizes) {
        if (std::abs(size.particles / n - 1) < 0.2) return &size;
    }
    return nullptr;
}

// One goal over several sizes: `value` where it is a number, to be at most `most` or at least `least`.
template <typename F>
Goal over_sizes(std::string what, std::string bound, const SpeedBench& bench, std::span<const double> sizes,
                const F& value, double least, double most, const char* form) {
    Goal goal{std::move(what), std::move(bound), "", -1};
    for (const double n : sizes) {
        const SizeRecord* const size = near(bench, n);
        const double v = size ? value(*size) : no_number;
        if (!std::isfinite(v)) continue;
        goal.reached += goal.reached.empty() ? "" : ", ";
        goal.reached += fmt::format(fmt::runtime(form), v) + " at " + size_name(size->particles);
        goal.met = goal.met != 0 && v >= least && v <= most ? 1 : 0;
    }
    return goal;
}

double ratio(const Spread* above, const Spread* below) {
    return above && below && below->median > 0 ? above->median / below->median : no_number;
}
const Spread* solve_time(const SizeRecord& size, const char* name, int threads) {
    const SolveRecord* s = size.solve_of(name, threads);
    return s ? &s->seconds : nullptr;
}
const Spread* step_time(const SizeRecord& size, const char* name, int threads) {
    const StepRecord* s = size.step_of(name, threads);
    return s ? &s->seconds : nullptr;
}
double iteration_ratio(const SizeRecord& size, int threads) {
    const SolveRecord *ours = size.solve_of("stencil-block", threads),
                      *eigen = size.solve_of("Eigen CG, diagonal", 1);
    return ours && eigen ? eigen->row_iteration / ours->row_iteration : no_number;
}
// ns per particle and substep.
double explicit_cost(const SizeRecord& size, int threads) {
    const StepRecord* s = size.step_of("explicit", threads);
    return s ? 1e9 * s->seconds.median / (size.particles * s->substeps) : no_number;
}

Goal growth(const SpeedBench& bench) {
    Goal goal{"time of a step, from 10⁴ particles on", "≤ n^1.1", "", -1};
    const PowerLaw law = step_law(bench, nullptr, bench.threads, 8e3);
    if (!law.known()) return goal;
    goal.reached = fmt::format("n^{:.2f} over {} sizes to {}", law.exponent, law.points,
                               size_name(bench.sizes.back().particles));
    goal.met = law.exponent <= 1.1;
    return goal;
}

// How much slower the integrator that chooses is than the best of those it may choose from.
double auto_excess(const SizeRecord& size, int threads) {
    const Spread* chosen = step_time(size, "integrator auto", threads);
    double best = no_number;
    for (const char* name : {"explicit", "blocks", "multigrid"}) {
        const Spread* named = step_time(size, name, threads);
        if (named && !(best <= named->median)) best = named->median;
    }
    return chosen ? 100 * (chosen->median / best - 1) : no_number;
}

}  // namespace

std::vector<Goal> judge_goals(const SpeedBench& bench) {
    constexpr double any = std::numeric_limits<double>::infinity();
    constexpr double to_160k[] = {1e4, 4e4, 1.6e5}, to_million[] = {1e6}, ten[] = {1e4}, forty[] = {4e4},
                     large[] = {4e4, 1.6e5}, two_to_40k[] = {4e4, 1.6e5, 1e6}, all[] = {1e4, 4e4, 1.6e5, 1e6};
    const int threads = bench.threads;
    const double slower = goal_triad[0] / bench.memory_triad[0],
                 slower_all = goal_triad[1] / bench.memory_triad[1];
    const auto cycles = [](const SizeRecord& size) {
        const SolveRecord* s = size.solve_of("multigrid", 1);
        return s ? s->iterations : no_number;
    };
    const auto add = [&](auto... with) { return over_sizes(with...); };
    std::vector<Goal> goals{growth(bench)};
    goals.push_back(add("multigrid iterations to 1e-3", "≤ 8", bench, std::span<const double>(to_160k),
                        cycles, 0.0, 8.0, "{:.0f}"));
    goals.push_back(add("the same at 10⁶", "≤ 12", bench, std::span<const double>(to_million), cycles, 0.0,
                        12.0, "{:.0f}"));
    goals.push_back(add(
        "a CG iteration against Eigen's, one thread", "13 times less", bench, std::span<const double>(ten),
        [](const SizeRecord& s) { return iteration_ratio(s, 1); }, 13.0, any, "{:.1f}"));
    goals.push_back(add(
        "the same, all threads against Eigen's one", "27 times less", bench, std::span<const double>(forty),
        [&](const SizeRecord& s) { return iteration_ratio(s, threads); }, 27.0, any, "{:.1f}"));
    goals.push_back(add(
        "a solve against plain constrained-block CG, all threads", "25 times less", bench,
        std::span<const double>(large),
        [&](const SizeRecord& s) {
            return ratio(solve_time(s, "constrained-block", threads), solve_time(s, "auto", threads));
        },
        25.0, any, "{:.1f}"));
    goals.push_back(add(
        "forces and coefficients, one thread", fmt::format("≤ {:.1f} ns per particle", 11 * slower), bench,
        std::span<const double>(all),
        [](const SizeRecord& s) {
            const StepRecord* step = s.step_of(own_step, 1);
            return step ? 1e9 * step->stages.forces / s.particles : no_number;
        },
        0.0, 11 * slower, "{:.0f} ns"));
    goals.push_back(add(
        "explicit substep, one thread", fmt::format("≤ {:.1f} ns per particle", 6 * slower), bench,
        std::span<const double>(all), [](const SizeRecord& s) { return explicit_cost(s, 1); }, 0.0,
        6 * slower, "{:.1f} ns"));
    goals.push_back(add(
        "explicit substep, all threads", fmt::format("≤ {:.1f} ns per particle", 4 * slower_all), bench,
        std::span<const double>(all),
        [&](const SizeRecord& s) { return threads > 1 ? explicit_cost(s, threads) : no_number; }, 0.0,
        4 * slower_all, "{:.1f} ns"));
    goals.push_back(add(
        "integrator auto above the best named by hand", "≤ 15%", bench, std::span<const double>(all),
        [&](const SizeRecord& s) { return auto_excess(s, threads); }, -any, 15.0, "{:+.0f}%"));
    goals.push_back(add(
        "memory in all", "< 1 kB per particle", bench, std::span<const double>(all),
        [](const SizeRecord& s) { return s.memory.peak; }, 0.0, 1000.0, "{:.0f} B"));
    goals.push_back(add(
        "a step on two threads against one", "1.8 times faster", bench, std::span<const double>(two_to_40k),
        [](const SizeRecord& s) { return ratio(step_time(s, own_step, 1), step_time(s, own_step, 2)); }, 1.8,
        any, "{:.2f}"));
    return goals;
}

}  // namespace unravel::tool
