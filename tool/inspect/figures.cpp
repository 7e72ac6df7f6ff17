#include "tool/inspect/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace unravel::tool {

Plot size_histogram(const InspectedStep& step) {
    // Ranges 1, 2–3, 4–7, …: sizes reach from one particle to all.
    std::map<int, std::pair<std::uint32_t, std::uint32_t>> ranges;
    for (const ComponentRow& row : step.components) {
        auto& [count, particles] = ranges[std::bit_width(row.particles) - 1];
        ++count;
        particles += row.particles;
    }
    Plot plot;
    plot.title = "Components by size";
    plot.x.label = "particles of a component";
    plot.y.label = "components, particles in them";
    plot.y.log = true;
    plot.y.from = 0.7;
    plot.series = {{"components", {}, SeriesStyle::bars}, {"particles", {}, SeriesStyle::bars}};
    const int last = ranges.empty() ? 0 : ranges.rbegin()->first;
    for (int k = 0; k <= last; ++k) {
        plot.x.categories.push_back(k == 0 ? "1" : fmt::format("{}–{}", 1 << k, (2 << k) - 1));
        const auto [count, particles] =
            ranges.contains(k) ? ranges[k] : std::pair<std::uint32_t, std::uint32_t>{};
        PlotPoint of_count{static_cast<double>(k), static_cast<double>(count)};
        PlotPoint of_particles{static_cast<double>(k), static_cast<double>(particles)};
        of_count.note = count > 0 ? std::to_string(count) : "";
        of_particles.note = count > 0 ? std::to_string(particles) : "";
        plot.series[0].points.push_back(of_count);
        plot.series[1].points.push_back(of_particles);
    }
    return plot;
}

Plot kappa_histogram(const InspectedStep& step) {
    constexpr double bins_per_decade = 5;
    Plot plot;
    plot.title = "Springs by κ = (h/m)(k_s h + 2 k_d)";
    plot.x.label = "log₁₀ κ";
    plot.y.label = "stretch and shear springs";
    plot.y.log = true;
    plot.y.from = 0.7;
    for (const SpringState state : {SpringState::implicit, SpringState::explicit_, SpringState::inactive}) {
        std::map<int, std::uint32_t> bins;
        for (std::size_t s = 0; s < step.kappa.size(); ++s) {
            if (step.record.springs[s] == state && step.kappa[s] > 0)
                ++bins[static_cast<int>(std::floor(std::log10(step.kappa[s]) * bins_per_decade))];
        }
        PlotSeries series;
        series.label = state == SpringState::implicit    ? "implicit"
                       : state == SpringState::explicit_ ? "explicit"
                                                         : "inactive";
        series.style = SeriesStyle::bars;
        for (const auto& [bin, count] : bins)
            series.points.push_back({(bin + 0.5) / bins_per_decade, static_cast<double>(count)});
        if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    if (step.simulation.options.integrator == Integrator::adaptive_imex) {
        const double threshold = step.simulation.options.threshold;
        if (threshold > 0)
            plot.guides.push_back({std::log10(threshold), false, fmt::format("threshold {:g}", threshold)});
    }
    // Bars are as wide as bins whichever of them are there.
    double low = 0, high = 0;
    bool any = false;
    const auto extend = [&](double x) {
        low = any ? std::min(low, x) : x;
        high = any ? std::max(high, x) : x;
        any = true;
    };
    for (const PlotSeries& series : plot.series) {
        for (const PlotPoint& p : series.points) extend(p.x);
    }
    for (const PlotGuide& guide : plot.guides) extend(guide.value);
    plot.x.from = low - 1.5 / bins_per_decade;
    plot.x.to = high + 1.5 / bins_per_decade;
    plot.bar_width = 1 / bins_per_decade;
    return plot;
}

std::vector<Pattern> step_patterns(const InspectedStep& step) {
    const StepTrace trace = step.trace();
    // The cloths' own springs come first.
    std::vector<std::array<std::uint32_t, 2>> extra;
    for (const SpringFamily& family : std::span(trace.couplings.springs).subspan(1)) {
        for (std::size_t s = 0; s < family.springs->size(); ++s) {
            if (family.forces->state[s] == SpringState::implicit)
                extra.push_back({family.springs->i[s], family.springs->j[s]});
        }
    }
    const Pattern assembled = step_pattern(step.simulation.model, step.record.springs, extra);
    return {implicit_pattern(step.simulation.model), assembled,
            reordered_pattern(assembled, trace.components)};
}

std::vector<Figure> step_figures(const InspectedStep& step) {
    std::vector<Figure> figures;
    const std::vector<Pattern> patterns = step_patterns(step);
    const char* const names[] = {"matrix_implicit", "matrix_step", "matrix_reordered"};
    const char* const captions[] = {
        "A of the fully implicit scheme: every spring couples its particles, at every step (paper Fig. 3).",
        "A of this step in particle order: active springs handled implicitly (Fig. 4).",
        "The same reordered by component; each red square is solved on its own (Fig. 5). Rows of fully "
        "constrained "
        "particles come last and are never solved."};
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        figures.push_back({names[k], captions[k], pattern_svg(patterns[k]), pattern_image(patterns[k]),
                           patterns[k].rows <= 400});
    }
    const Plot sizes = size_histogram(step), kappas = kappa_histogram(step);
    figures.push_back({"sizes", "Components of the step by size.", plot_svg(sizes), plot_image(sizes), true});
    figures.push_back({"kappa",
                       "Springs by the stability criterion of Eq. (7): explicit where κ is not above the "
                       "threshold, inactive where slack.",
                       plot_svg(kappas), plot_image(kappas), true});
    return figures;
}

}  // namespace unravel::tool
