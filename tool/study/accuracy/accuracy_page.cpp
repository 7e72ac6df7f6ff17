#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tool/study/accuracy/accuracy_verdict.hpp"

#include "tool/report/html.hpp"

namespace unravel::tool {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// Of the component palette; `auto` lies on one of the others and has to stand out from them.
constexpr int front_color = 7, automatic_color = 9;

int color_of(Integrator integrator) {
    return integrator == Integrator::automatic ? automatic_color : static_cast<int>(integrator);
}

// The document within another: without its XML declaration.
std::string inlined(const std::string& svg) {
    const std::size_t begin = svg.find("<svg");
    return begin == svg.npos ? svg : svg.substr(begin);
}

PlotPoint plotted(const AccuracyPoint& p, double seconds_simulated, CostAxis axis) {
    PlotPoint point;
    point.y = p.broke ? std::numeric_limits<double>::infinity() : p.error;
    if (axis == CostAxis::rvm) {
        point.x = static_cast<double>(p.rvm) / seconds_simulated;
        return point;
    }
    point.x = p.median() / seconds_simulated;
    if (p.seconds.size() > 1) {
        point.left = p.quantile(0.25) / seconds_simulated;
        point.right = p.quantile(0.75) / seconds_simulated;
    }
    return point;
}

bool best_of_front(const AccuracyPoint& p, const std::vector<const AccuracyPoint*>& front) {
    return std::find(front.begin(), front.end(), &p) != front.end();
}

// Beside the rightmost cross.
void name_the_broken(Plot& plot) {
    PlotPoint* last = nullptr;
    for (PlotSeries& series : plot.series) {
        if (series.faint) continue;
        for (PlotPoint& p : series.points) {
            if (!std::isfinite(p.y) && (!last || p.x > last->x)) last = &p;
        }
    }
    if (last) last->note = "blew up";
}

}  // namespace

Plot accuracy_plot(const std::vector<AccuracyPoint>& points, const AccuracyReference& reference,
                   const std::string& scene, double seconds_simulated, const Rate& fps, CostAxis axis) {
    Plot plot;
    plot.title = fmt::format("What accuracy costs: {} (lower: more accurate; further left: cheaper)", scene);
    plot.x.label = axis == CostAxis::time ? "computing time for a second simulated [s]"
                                          : "row-vector multiplies for a second simulated";
    plot.y.label = "error: RMS distance from the reference / cloth's diagonal";
    plot.x.log = plot.y.log = true;
    plot.width = 900;
    plot.height = 600;
    const std::vector<const AccuracyPoint*> front = pareto_front(points);
    for (const AccuracyCurve& curve : curves_of(points, reference.floor)) {
        // Explicit steps multiply no rows.
        if (axis == CostAxis::rvm &&
            std::all_of(curve.points.begin(), curve.points.end(), [](const auto* p) { return p->rvm == 0; }))
            continue;
        const AccuracySetting& setting = curve.points.front()->setting;
        PlotSeries series;
        if (setting.plain()) {
            series.label = curve.method;
            if (setting.integrator == Integrator::explicit_) series.label += " substeps";
            // The steps of `auto` are not all its own.
            if (curve.order && setting.integrator != Integrator::automatic)
                series.label += fmt::format(" (order {:.1f})", *curve.order);
            series.color = color_of(setting.integrator);
        } else {
            // The table tells them apart.
            series.label = "other thresholds, tolerances …";
            series.style = SeriesStyle::points;
            series.faint = true;
        }
        auto same = std::find_if(plot.series.begin(), plot.series.end(), [&](const PlotSeries& other) {
            return other.style == series.style && other.label == series.label;
        });
        if (same == plot.series.end()) same = plot.series.insert(plot.series.end(), series);
        for (const AccuracyPoint* p : curve.points) {
            same->points.push_back(plotted(*p, seconds_simulated, axis));
            // Bars of points without a line would bury those with one.
            if (!setting.plain()) same->points.back().left = same->points.back().right = nothing;
            if (setting.plain() && best_of_front(*p, front))
                same->points.back().note = step_text(fps, p->setting.steps_per_frame) + " s";
        }
    }
    // Behind the lines, and last in the legend but for the front.
    const auto varied =
        std::find_if(plot.series.begin(), plot.series.end(), [](const PlotSeries& s) { return s.faint; });
    if (varied != plot.series.end()) {
        PlotSeries behind = *varied;
        plot.series.erase(varied);
        PlotSeries named{behind.label, {}, behind.style};
        named.faint = true;
        behind.label.clear();
        plot.series.insert(plot.series.begin(), std::move(behind));
        plot.series.push_back(std::move(named));
    }
    name_the_broken(plot);
    if (axis == CostAxis::time) {
        PlotSeries line{"cheapest for its error", {}, SeriesStyle::line, true, front_color};
        for (const AccuracyPoint* p : front) {
            line.points.push_back(plotted(*p, seconds_simulated, axis));
            line.points.back().left = line.points.back().right = nothing;
        }
        plot.series.push_back(std::move(line));
    }
    plot.guides.push_back({reference.floor, true, "floor: the two references differ by this"});
    return plot;
}

std::string accuracy_page(const std::vector<AccuracyPoint>& points, const AccuracyReference& reference,
                          const std::string& scene, double seconds_simulated, const Rate& fps, double error) {
    return fmt::format(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Accuracy of {0}</title>\n"
        "<style>body{{font:15px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}}"
        "svg{{max-width:100%;height:auto}}pre{{overflow-x:auto;font-size:12px}}</style>\n"
        "<h1>What accuracy costs: {0}</h1>\n<p><strong>{1}</strong></p>\n{2}\n"
        "<p>Each point is one run of the scene's first {3:.2f} s. Its error is the distance of its particles "
        "from a reference at every frame, RMS over particles and frames, as a share of the cloth's diagonal; "
        "its cost is the median time of the steps over interleaved runs, with their middle half as a bar. "
        "Along a line the step is halved from point to point (of explicit it is the substep of one step a "
        "frame; auto divides its steps where it takes explicit ones); steps are named where no other run "
        "beats the "
        "point in both. Crosses at the upper edge are runs that blew up. The reference is {4} at steps of "
        "{5} s and a tolerance of {6:.0e}; {7} at steps of {8} s differs from it by {9:.2e}: nothing "
        "below "
        "that line can be told apart. Lines hold a threshold of 0.2, a tolerance of 1e-3 and no activation "
        "band; grey points "
        "vary "
        "one of them, how bending is treated, or how slack springs are activated.</p>\n{10}\n"
        "<pre>{11}</pre></html>\n",
        html_text(scene), html_text(recommendation(points, error, seconds_simulated, fps)),
        inlined(plot_svg(accuracy_plot(points, reference, scene, seconds_simulated, fps, CostAxis::time))),
        seconds_simulated, reference.first.method(), step_text(fps, reference.first.steps_per_frame),
        reference.first.tolerance, reference.second.method(),
        step_text(fps, reference.second.steps_per_frame), reference.floor,
        inlined(plot_svg(accuracy_plot(points, reference, scene, seconds_simulated, fps, CostAxis::rvm))),
        html_text(accuracy_table(points, reference, error, fps)));
}

}  // namespace unravel::tool
