#include "tool/study/accuracy/accuracy_contrast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace unravel::tool {

namespace {

// Errors nearer to the floor than this are the references' doubt as much as a method's error.
constexpr double winners_clear_of_floor = 2;
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

// Without `auto`, which takes one of the others.
const Plain* cheapest_at(const std::vector<Plain>& curves, double error) {
    const Plain* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Plain& plain : curves) {
        if (plain.integrator == Integrator::automatic) continue;
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

// "from 3e-02 to 1e-03", of levels that follow each other.
std::string range_text(double from, double to) {
    return from == to ? fmt::format("at {:.0e}", from) : fmt::format("from {:.0e} to {:.0e}", from, to);
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
        const bool one = range.from == range.to;
        text += fmt::format(
            "{}{} {} is cheapest ({:.3g} s per second simulated at {:.0e})",
            !text.empty() ? ", "
            : one         ? "for an error "
                          : "for errors ",
            text.empty() && one ? fmt::format("of {:.0e}", range.to) : range_text(range.from, range.to),
            integrator_name(range.best->integrator), *cost_at(range.best->curve, range.to) / study.window(),
            range.to);
    }
    return text.empty() ? "no method came within an error that the reference can tell" : text;
}

constexpr double never = std::numeric_limits<double>::infinity();

// s; `never` where a method was not tried or does not come within the error.
double cost_or_never(const AccuracyCurve* curve, double error) {
    return curve ? cost_at(*curve, error).value_or(never) : never;
}

// Smallest and greatest ratio of the costs of two methods over the errors that both reach, and where.
struct Ratios {
    double least = std::numeric_limits<double>::infinity(), most = 0, at_most = 0;
    bool any() const { return most > 0; }
    void add(double ratio, double level) {
        least = std::min(least, ratio);
        if (ratio > most) most = ratio, at_most = level;
    }
};

// Where a method that mixes explicit and implicit costs no more than the better of the two, and how much more
// elsewhere.
std::string following(const AccuracyStudy& study, Integrator integrator) {
    const std::vector<Plain> curves = plain_curves(study);
    const AccuracyCurve *own = curve_of(curves, integrator),
                        *explicit_ = curve_of(curves, Integrator::explicit_),
                        *implicit = curve_of(curves, Integrator::implicit);
    const char* name = integrator_name(integrator);
    if (!own) return fmt::format("{} was not tried", name);
    Ratios to_implicit, to_better;
    std::vector<std::array<double, 2>> follows;  // ranges of errors
    bool within = false;
    const char* better_at_most = "";
    for (const double level : error_levels(study)) {
        const double cost = cost_or_never(own, level), of_explicit = cost_or_never(explicit_, level),
                     of_implicit = cost_or_never(implicit, level);
        const bool explicit_better = of_explicit < of_implicit;
        const double better = std::min(of_explicit, of_implicit);
        if (cost == never || better == never) continue;
        const double ratio = cost / better;
        if (of_implicit < never) to_implicit.add(cost / of_implicit, level);
        if (ratio > to_better.most) better_at_most = explicit_better ? "explicit" : "implicit";
        to_better.add(ratio, level);
        if (ratio > same_time) {
            within = false;
        } else if (within) {
            follows.back()[1] = level;
        } else {
            follows.push_back({level, level});
            within = true;
        }
    }
    if (!to_better.any()) return fmt::format("{} has no error in common with explicit or implicit", name);
    std::string text = name;
    if (to_better.most <= same_time) {
        text +=
            fmt::format(" is never dearer than the better of explicit and implicit ({:.2g} to {:.2g} times)",
                        to_better.least, to_better.most);
    } else {
        std::string where;
        for (const auto& [from, to] : follows) where += (where.empty() ? "" : " and ") + range_text(from, to);
        text += where.empty()
                    ? " is everywhere dearer than the better of explicit and implicit"
                    : fmt::format(" costs no more than the better of explicit and implicit {}", where);
        text += fmt::format(", elsewhere at most {:.2g} times as much ({}, {} being the better)",
                            to_better.most, range_text(to_better.at_most, to_better.at_most), better_at_most);
    }
    if (to_implicit.any()) {
        text += fmt::format("; against implicit at the same error it takes {:.0f} to {:.0f}% of the time",
                            100 * to_implicit.least, 100 * to_implicit.most);
    }
    return text;
}

// What `auto` takes is seen by whether it multiplied rows.
std::string automatic_words(const AccuracyStudy& study) {
    bool swept = false, coupled = false;
    for (const AccuracyPoint& p : study.points) {
        if (p.broke || p.setting.integrator != Integrator::automatic) continue;
        (p.rvm == 0 ? swept : coupled) = true;
    }
    if (!swept && !coupled) return "auto was not tried";
    const char* taken = swept && coupled ? "explicit substeps at some steps and adaptive IMEX at others"
                        : swept          ? "explicit substeps"
                                         : "adaptive IMEX";
    return fmt::format("auto takes {}; {}", taken, following(study, Integrator::automatic));
}

// What stability alone asks of explicit steps: the largest that did not blow up.
std::string explicit_words(const AccuracyStudy& study) {
    const std::vector<Plain> curves = plain_curves(study);
    const AccuracyCurve* curve = curve_of(curves, Integrator::explicit_);
    if (!curve) return "explicit was not tried";
    const auto stable = std::find_if(curve->points.begin(), curve->points.end(),
                                     [](const AccuracyPoint* p) { return !p->broke; });
    const Rate& fps = study.scene.clip.fps;
    if (stable == curve->points.end())
        return fmt::format("explicit blew up at every step tried, down to {} s",
                           step_text(fps, curve->points.back()->setting.steps_per_frame));
    const AccuracyPoint& p = **stable;
    std::string text =
        fmt::format("explicit is stable from steps of {} s on, with an error of {:.1g} at once",
                    step_text(fps, p.setting.steps_per_frame), p.error);
    std::vector<Plain> others;
    for (const Plain& plain : curves) {
        if (plain.integrator != Integrator::explicit_) others.push_back(plain);
    }
    const Plain* rival = cheapest_at(others, p.error);
    if (!rival) return text + ", which no other method reached";
    const double ratio = p.median() / *cost_at(rival->curve, p.error);
    return text + fmt::format(" and {:.2g} times the time of the cheapest other method at that error ({})",
                              ratio, integrator_name(rival->integrator));
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
    const double finest = winners_clear_of_floor * study.reference.floor;
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
    for (const Plain& plain : curves) text += fmt::format("{:>16}", integrator_name(plain.integrator));
    text += "   cheapest\n";
    for (const double level : error_levels(study)) {
        if (!cheapest_at(curves, level)) continue;
        text += fmt::format("{:<10.0e}", level);
        for (const Plain& plain : curves) {
            const std::optional<double> cost = cost_at(plain.curve, level);
            text += fmt::format("{:>16}", cost ? fmt::format("{:.3f} s", *cost / study.window()) : "-");
        }
        const Plain* best = cheapest_at(curves, level);
        text += fmt::format("   {}\n", best ? integrator_name(best->integrator) : "-");
    }
    return text;
}

std::string contrast_words(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times) {
    const auto words = [](const AccuracyStudy& study) {
        return fmt::format("{}. {}. {}. {}.", winners(study), capital(explicit_words(study)),
                           capital(following(study, Integrator::adaptive_imex)),
                           capital(automatic_words(study)));
    };
    return fmt::format("On the cloth as it is, {}\nOn one {:g} times stiffer, {}", words(soft), times,
                       words(stiff));
}

std::array<Plot, 2> contrast_plots(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times) {
    std::array<Plot, 2> plots{accuracy_plot(soft.points, soft.reference, soft.scene.name, soft.window(),
                                            soft.scene.clip.fps, CostAxis::time),
                              accuracy_plot(stiff.points, stiff.reference, stiff.scene.name, stiff.window(),
                                            stiff.scene.clip.fps, CostAxis::time)};
    plots[0].title = fmt::format("What accuracy costs: {}", soft.scene.name);
    plots[1].title = fmt::format("The same cloth {:g} times stiffer", times);
    double low[2] = {1e300, 1e300}, high[2] = {0, 0};
    const auto extend = [&](int axis, double value) {
        if (!std::isfinite(value) || value <= 0) return;
        low[axis] = std::min(low[axis], value);
        high[axis] = std::max(high[axis], value);
    };
    for (Plot& plot : plots) {
        std::erase_if(plot.series, [](const PlotSeries& s) { return s.style == SeriesStyle::points; });
        for (const PlotSeries& series : plot.series) {
            for (const PlotPoint& p : series.points) {
                extend(0, p.x);
                extend(1, p.y);
            }
        }
        for (const PlotGuide& guide : plot.guides) extend(1, guide.value);
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
    std::string words = contrast_words(soft, stiff, times);
    words.replace(words.find('\n'), 1, "</strong></p>\n<p><strong>");
    return fmt::format(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Soft and stiff: {0}</title>\n"
        "<style>body{{font:15px/1.5 sans-serif;max-width:82em;margin:2em auto;padding:0 1em}}"
        "svg{{max-width:100%;height:auto}}pre{{overflow-x:auto;font-size:12px}}</style>\n"
        "<h1>Soft and stiff: {0}</h1>\n<p><strong>{1}</strong></p>\n{2}\n"
        "<p>Seconds of computing for each second simulated to stay within an error (RMS distance from the "
        "reference over the cloth's diagonal), between the steps tried interpolated on log scales; methods "
        "at a threshold of 0.2 and a tolerance of 1e-3.</p>\n<h2>As it is</h2><pre>{3}</pre>\n"
        "<h2>{4:g} times stiffer</h2><pre>{5}</pre></html>\n",
        soft.scene.name, words, svg.substr(svg.find("<svg")), winner_table(soft), times, winner_table(stiff));
}

}  // namespace unravel::tool
