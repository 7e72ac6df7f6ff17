#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool/bench/measure_steps.hpp"
#include "tool/bench/speed_report.hpp"

namespace unravel::tool {

namespace {

PlotAxis particles_axis() {
    return {"particles n", true, {}, {}, {}};
}

std::string with_exponent(const std::string& name, const std::vector<Measured>& points) {
    const PowerLaw law = fit_power(points);
    return law.known() ? fmt::format("{}, n^{:.2f}", name, law.exponent) : name;
}

// A series of what `value` has for each size, where it is positive; low and high are the spread.
struct Value {
    double middle = 0, low = 0, high = 0;
};
template <typename F>
void add_series(Plot& plot, const SpeedBench& bench, const std::string& name, bool dashed, bool exponents,
                const F& value) {
    PlotSeries series;
    series.dashed = dashed;
    std::vector<Measured> points;
    for (const SizeRecord& size : bench.sizes) {
        const Value v = value(size);
        if (!(v.middle > 0)) continue;
        PlotPoint point{size.particles, v.middle};
        if (v.low > 0) point.low = v.low, point.high = v.high;
        series.points.push_back(point);
        points.push_back({size.particles, v.middle});
    }
    if (points.empty()) return;
    series.label = exponents ? with_exponent(name, points) : name;
    plot.series.push_back(std::move(series));
}

Value milliseconds(const Spread& s) {
    return {1e3 * s.median, 1e3 * s.low, 1e3 * s.high};
}

// A stage of a hundredth of some step.
bool matters(const SpeedBench& bench, double StageTimes::*slot) {
    return std::any_of(bench.sizes.begin(), bench.sizes.end(), [&](const SizeRecord& size) {
        const StepRecord* s = size.step_of(own_step, bench.threads);
        return s && s->stages.*slot > 0.01 * s->seconds.median;
    });
}

Plot step_plot(const SpeedBench& bench) {
    Plot plot;
    plot.title = fmt::format("A step of {} by stage, {} thread{}", bench.scene, bench.threads,
                             bench.threads == 1 ? "" : "s");
    plot.x = particles_axis();
    plot.y = {"ms", true, {}, {}, {}};
    add_series(plot, bench, "step", false, true, [&](const SizeRecord& size) {
        const StepRecord* s = size.step_of(own_step, bench.threads);
        return s ? milliseconds(s->seconds) : Value{};
    });
    if (bench.threads > 1) {
        add_series(plot, bench, "step, 1 thread", true, true, [&](const SizeRecord& size) {
            const StepRecord* s = size.step_of(own_step, 1);
            return s ? milliseconds(s->seconds) : Value{};
        });
    }
    for (const auto& [name, slot] : step_stages) {
        if (!matters(bench, slot)) continue;
        add_series(plot, bench, name, false, true, [&, at = slot](const SizeRecord& size) {
            const StepRecord* s = size.step_of(own_step, bench.threads);
            return s ? Value{1e3 * (s->stages.*at)} : Value{};
        });
    }
    return plot;
}

// Solvers of a plot: which, and on how many threads ours.
constexpr const char* compared[] = {"auto", "multigrid",          "stencil-block", "constrained-block",
                                    "none", "Eigen CG, diagonal", "CHOLMOD",       "Eigen LDLT"};

const SolveRecord* solve_at(const SpeedBench& bench, const SizeRecord& size, const char* name) {
    const SolveRecord* all = size.solve_of(name, bench.threads);
    return all ? all : size.solve_of(name, 1);
}

std::string solver_name(const SpeedBench& bench, const char* name) {
    for (const SizeRecord& size : bench.sizes) {
        if (const SolveRecord* s = solve_at(bench, size, name); s && bench.threads > 1 && s->threads == 1)
            return std::string(name) + ", 1 thread";
    }
    return name;
}

Plot solve_plot(const SpeedBench& bench) {
    Plot plot;
    plot.title = "A solve to 1e-3, set-up included";
    plot.x = particles_axis();
    plot.y = {"ms", true, {}, {}, {}};
    for (const char* name : compared) {
        const bool peer = bench.sizes.empty() || name[0] == 'E' || name[0] == 'C';
        add_series(plot, bench, solver_name(bench, name), peer, true, [&](const SizeRecord& size) {
            const SolveRecord* s = solve_at(bench, size, name);
            return s ? milliseconds(s->seconds) : Value{};
        });
    }
    return plot;
}

Plot iteration_plot(const SpeedBench& bench) {
    Plot plot;
    plot.title = "A CG iteration";
    plot.x = particles_axis();
    plot.y = {"ns per row", true, {}, {}, {}};
    for (const char* name : compared) {
        add_series(plot, bench, solver_name(bench, name), name[0] == 'E', false, [&](const SizeRecord& size) {
            const SolveRecord* s = solve_at(bench, size, name);
            return s && std::isfinite(s->row_iteration) ? Value{1e9 * s->row_iteration} : Value{};
        });
    }
    return plot;
}

Plot account_plot(const SpeedBench& bench) {
    Plot plot;
    plot.title = "A step on more threads, foretold from its work and span";
    plot.x = {"threads", true, {}, {}, {}};
    plot.y = {"times faster than one", true, {}, {}, {}};
    PlotSeries measured{"measured", {}, SeriesStyle::points};
    for (const SizeRecord& size : bench.sizes) {
        if (!(size.account.work() > 0)) continue;
        PlotSeries series{size_name(size.particles), {}, SeriesStyle::line_and_points};
        for (const int threads : {1, 2, 4, 8, 16, 32, 64})
            series.points.push_back({static_cast<double>(threads), size.account.speed_up(threads)});
        plot.series.push_back(std::move(series));
        const StepRecord* one = size.step_of(own_step, 1);
        for (const int threads : thread_counts(bench.threads)) {
            const StepRecord* many = size.step_of(own_step, threads);
            if (one && many && threads > 1)
                measured.points.push_back(
                    {static_cast<double>(threads), one->seconds.median / many->seconds.median});
        }
    }
    if (!measured.points.empty()) plot.series.push_back(std::move(measured));
    return plot;
}

}  // namespace

std::vector<Plot> speed_plots(const SpeedBench& bench) {
    return {step_plot(bench), solve_plot(bench)};
}

std::vector<Plot> detail_plots(const SpeedBench& bench) {
    return {iteration_plot(bench), account_plot(bench)};
}

}  // namespace unravel::tool
