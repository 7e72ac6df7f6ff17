#include "tool/studies/accuracy_contrast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/integrators/scheme.hpp"

namespace unravel {

namespace {

// Errors nearer to the floor than this are the references' doubt as much as a method's error.
constexpr double clear_of_floor = 2;
// Nobody asks for a cloth that is a fifth of its size off.
constexpr int coarsest_power = -1;
// Times nearer than this are the same.
constexpr double same_time = 1.05;

struct Plain {
    Integrator integrator;
    AccuracyCurve curve;
};

// One curve per integrator, without what was varied about it.
std::vector<Plain> plain_curves(const AccuracyStudy& study) {
    std::vector<Plain> plain;
    for (AccuracyCurve& curve : curves_of(study.points, study.reference.floor)) {
        const AccuracySetting& setting = curve.points.front()->setting;
        if (setting.plain()) plain.push_back({setting.integrator, std::move(curve)});
    }
    return plain;
}

const Plain* cheapest_at(const std::vector<Plain>& curves, double error) {
    const Plain* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Plain& plain : curves) {
        const std::optional<double> cost = cost_at(plain.curve, error);
        if (!cost || *cost >= least) continue;
        least = *cost;
        best = &plain;
    }
    return best;
}

const AccuracyCurve* curve_of(const std::vector<Plain>& curves, Integrator integrator) {
    for (const Plain& plain : curves) {
        if (plain.integrator == integrator) return &plain.curve;
    }
    return nullptr;
}

// "down to an error of 1e-3 explicit is cheapest, from there to 1e-4 bdf2"
std::string winners(const AccuracyStudy& study) {
    const std::vector<Plain> curves = plain_curves(study);
    struct Range {
        const Plain* best;
        double from, to;
    };
    std::vector<Range> ranges;
    for (const double level : error_levels(study)) {
        const Plain* best = cheapest_at(curves, level);
        if (!best) continue;
        if (ranges.empty() || ranges.back().best != best) {
            ranges.push_back({best, level, level});
        } else {
            ranges.back().to = level;
        }
    }
    std::string text;
    for (const Range& range : ranges) {
        const std::string where = range.from == range.to
                                      ? fmt::format("at an error of {:.0e}", range.to)
                                      : fmt::format("from {:.0e} to {:.0e}", range.from, range.to);
        text += fmt::format("{}{} {} is cheapest ({:.3g} s per second simulated at {:.0e})",
                            text.empty() ? "" : ", ", where, scheme_of(range.best->integrator).name,
                            *cost_at(range.best->curve, range.to) / study.window(), range.to);
    }
    return text.empty() ? "no method came within an error that the reference can tell" : text;
}

// How adaptive IMEX compares with the better of its two parents.
std::string following(const AccuracyStudy& study) {
    const std::vector<Plain> curves = plain_curves(study);
    const AccuracyCurve *adaptive = curve_of(curves, Integrator::adaptive_imex),
                        *parents[] = {curve_of(curves, Integrator::explicit_),
                                      curve_of(curves, Integrator::implicit)};
    if (!adaptive) return "";
    double worst = 0, best = std::numeric_limits<double>::infinity(), at_worst = 0, at_best = 0,
           saved_least = 1, saved_most = -1;
    for (const double level : error_levels(study)) {
        const std::optional<double> own = cost_at(*adaptive, level);
        double better = std::numeric_limits<double>::infinity();
        for (const AccuracyCurve* parent : parents) {
            if (parent) better = std::min(better, cost_at(*parent, level).value_or(better));
        }
        if (!own || !std::isfinite(better)) continue;
        if (*own / better > worst) worst = *own / better, at_worst = level;
        if (*own / better < best) best = *own / better, at_best = level;
        if (!parents[1]) continue;
        if (const std::optional<double> implicit = cost_at(*parents[1], level)) {
            saved_least = std::min(saved_least, 1 - *own / *implicit);
            saved_most = std::max(saved_most, 1 - *own / *implicit);
        }
    }
    if (worst == 0) return "adaptive-imex has no error in common with explicit or implicit";
    std::string text =
        worst <= same_time
            ? fmt::format(
                  "adaptive-imex is never dearer than the better of explicit and implicit ({:.2f} "
                  "times at {:.0e})",
                  worst, at_worst)
            : fmt::format(
                  "adaptive-imex costs {:.2g} to {:.2g} times the better of explicit and implicit "
                  "(at {:.0e}, at {:.0e})",
                  best, worst, at_best, at_worst);
    if (saved_most >= saved_least && saved_least >= 0) {
        text += fmt::format(", and {:.0f} to {:.0f}% less than implicit at the same error", 100 * saved_least,
                            100 * saved_most);
    } else if (saved_most >= saved_least) {
        text += fmt::format(", and at the same error between {:.2g} and {:.2g} times the time of implicit",
                            1 - saved_most, 1 - saved_least);
    }
    return text;
}

// What stability alone asks of explicit steps: the largest that did not blow up.
std::string explicit_words(const AccuracyStudy& study) {
    const std::vector<Plain> curves = plain_curves(study);
    const AccuracyCurve* curve = curve_of(curves, Integrator::explicit_);
    if (!curve) return "explicit was not tried";
    const auto stable = std::find_if(curve->points.begin(), curve->points.end(),
                                     [](const AccuracyPoint* p) { return !p->broke; });
    const int fps = study.scene.clip.fps;
    if (stable == curve->points.end())
        return fmt::format("explicit blew up at every step tried, down to 1/{} s",
                           curve->points.back()->setting.steps_per_frame * fps);
    const AccuracyPoint& p = **stable;
    std::string text =
        fmt::format("explicit is stable from steps of 1/{} s on, with an error of {:.1g} at once",
                    p.setting.steps_per_frame * fps, p.error);
    std::vector<Plain> others;
    for (const Plain& plain : curves) {
        if (plain.integrator != Integrator::explicit_) others.push_back(plain);
    }
    const Plain* rival = cheapest_at(others, p.error);
    if (!rival) return text + ", which no other method reached";
    const double ratio = p.median() / *cost_at(rival->curve, p.error);
    return text + fmt::format(" and {:.2g} times the time of the cheapest other method at that error ({})",
                              ratio, scheme_of(rival->integrator).name);
}

// Names of methods stand once, beside the right plot; orders differ between the two and are left out.
void one_legend(std::array<Plot, 2>& plots) {
    for (Plot& plot : plots) {
        for (PlotSeries& series : plot.series) {
            const std::size_t order = series.label.find(" (order");
            if (order != series.label.npos) series.label.erase(order);
        }
    }
    for (PlotSeries& left : plots[0].series) {
        const bool named = std::any_of(plots[1].series.begin(), plots[1].series.end(),
                                       [&](const PlotSeries& s) { return s.label == left.label; });
        if (!named) {
            plots[1].series.push_back(left);
            plots[1].series.back().points.clear();
        }
        left.label.clear();
    }
}

std::string capital(std::string text) {
    if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

}  // namespace

Scene stiffened(const Scene& scene, double times) {
    Scene stiff = scene;
    const auto stiffen = [&](Material& material) {
        for (double& stretch : material.stretch) stretch *= times;
        material.shear *= times;
    };
    for (Cloth& cloth : stiff.cloths) {
        stiffen(cloth.material);
        for (Region& region : cloth.regions) {
            if (region.material) stiffen(*region.material);
        }
    }
    return stiff;
}

std::optional<double> cost_at(const AccuracyCurve& curve, double error) {
    std::optional<double> cost = seconds_at(curve, error);
    for (const AccuracyPoint* p : curve.points) {
        if (p->broke || p->error > error) continue;
        cost = std::min(cost.value_or(p->median()), p->median());
    }
    return cost;
}

std::vector<double> error_levels(const AccuracyStudy& study) {
    double coarsest = 0;
    for (const AccuracyPoint& p : study.points) {
        if (!p.broke) coarsest = std::max(coarsest, p.error);
    }
    const double finest = clear_of_floor * study.reference.floor;
    std::vector<double> levels;
    if (!(finest > 0)) return levels;
    for (int power = coarsest_power; std::pow(10.0, power) > finest; --power) {
        for (const double level : {std::pow(10.0, power), 0.3 * std::pow(10.0, power)}) {
            if (level <= coarsest && level > finest) levels.push_back(level);
        }
    }
    return levels;
}

std::string winner_table(const AccuracyStudy& study) {
    const std::vector<Plain> curves = plain_curves(study);
    std::string text = fmt::format("{:<10}", "error");
    for (const Plain& plain : curves) text += fmt::format("{:>16}", scheme_of(plain.integrator).name);
    text += "   cheapest\n";
    for (const double level : error_levels(study)) {
        text += fmt::format("{:<10.0e}", level);
        for (const Plain& plain : curves) {
            const std::optional<double> cost = cost_at(plain.curve, level);
            text += fmt::format("{:>16}", cost ? fmt::format("{:.3f} s", *cost / study.window()) : "-");
        }
        const Plain* best = cheapest_at(curves, level);
        text += fmt::format("   {}\n", best ? scheme_of(best->integrator).name : "-");
    }
    return text;
}

std::string contrast_words(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times) {
    return fmt::format("On the cloth as it is, {}. {}. {}. On one {:g} times stiffer, {}. {}. {}.",
                       winners(soft), capital(explicit_words(soft)), capital(following(soft)), times,
                       winners(stiff), capital(explicit_words(stiff)), capital(following(stiff)));
}

std::array<Plot, 2> contrast_plots(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times) {
    std::array<Plot, 2> plots{accuracy_plot(soft.points, soft.reference, soft.scene.name, soft.window(),
                                            soft.scene.clip.fps, CostAxis::time),
                              accuracy_plot(stiff.points, stiff.reference, stiff.scene.name, stiff.window(),
                                            stiff.scene.clip.fps, CostAxis::time)};
    plots[0].title = fmt::format("What accuracy costs: {}", soft.scene.name);
    plots[1].title = fmt::format("The same cloth {:g} times stiffer", times);
    double low[2] = {1e300, 1e300}, high[2] = {0, 0};
    const auto see = [&](int axis, double value) {
        if (!std::isfinite(value) || value <= 0) return;
        low[axis] = std::min(low[axis], value);
        high[axis] = std::max(high[axis], value);
    };
    for (Plot& plot : plots) {
        std::erase_if(plot.series, [](const PlotSeries& s) { return s.style == SeriesStyle::points; });
        for (const PlotSeries& series : plot.series) {
            for (const PlotPoint& p : series.points) {
                see(0, p.x);
                see(1, p.y);
            }
        }
        for (const PlotGuide& guide : plot.guides) see(1, guide.value);
    }
    for (Plot& plot : plots) {
        plot.x.from = low[0] / 1.3, plot.x.to = high[0] * 1.3;
        plot.y.from = low[1] / 1.3, plot.y.to = high[1] * 1.5;
        plot.height = 460;
    }
    one_legend(plots);
    plots[0].width = 560;
    plots[1].width = 730;
    return plots;
}

std::string contrast_page(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times) {
    const std::array<Plot, 2> plots = contrast_plots(soft, stiff, times);
    const std::string svg = plots_svg(plots);
    return fmt::format(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Soft and stiff: {0}</title>\n"
        "<style>body{{font:15px/1.5 sans-serif;max-width:82em;margin:2em auto;padding:0 1em}}"
        "svg{{max-width:100%;height:auto}}pre{{overflow-x:auto;font-size:12px}}</style>\n"
        "<h1>Soft and stiff: {0}</h1>\n<p><strong>{1}</strong></p>\n{2}\n"
        "<p>Seconds of computing for each second simulated to stay within an error (RMS distance from the "
        "reference over the cloth's diagonal), between the steps tried interpolated on log scales; methods "
        "at a threshold of 0.2 and a tolerance of 1e-3.</p>\n<h2>As it is</h2><pre>{3}</pre>\n"
        "<h2>{4:g} times stiffer</h2><pre>{5}</pre></html>\n",
        soft.scene.name, contrast_words(soft, stiff, times), svg.substr(svg.find("<svg")), winner_table(soft),
        times, winner_table(stiff));
}

}  // namespace unravel
