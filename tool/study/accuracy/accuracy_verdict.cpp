#include "tool/study/accuracy/accuracy_verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace unravel::tool {

namespace {

// Errors nearer to the floor than this are the references' doubt as much as the method's error.
constexpr double clear_of_floor = 3;

std::string step_text(const AccuracySetting& s, const Rate& fps) {
    return step_text(fps, s.steps_per_frame) + " s";
}

// What to write into the scene.
std::string how_to(const AccuracySetting& s, const Rate& fps) {
    if (s.integrator == Integrator::explicit_)
        return fmt::format("explicit with {} substeps of {} (solver.step = \"{}\", solver.substeps = {})",
                           s.steps_per_frame, step_text(s, fps), step_text(fps, 1), s.steps_per_frame);
    return fmt::format("{} with steps of {} and solver.activation_band = {}", s.method(), step_text(s, fps),
                       s.band);
}

const AccuracyPoint* cheapest_within(const std::vector<AccuracyPoint>& points, double error,
                                     const Integrator* only) {
    const AccuracyPoint* best = nullptr;
    for (const AccuracyPoint& p : points) {
        if (p.broke || p.error > error || (only && p.setting.integrator != *only)) continue;
        if (!best || p.median() < best->median()) best = &p;
    }
    return best;
}

}  // namespace

std::vector<AccuracyCurve> curves_of(const std::vector<AccuracyPoint>& points, double floor) {
    std::vector<AccuracyCurve> curves;
    for (const AccuracyPoint& p : points) {
        const std::string method = p.setting.method();
        auto curve = std::find_if(curves.begin(), curves.end(),
                                  [&](const AccuracyCurve& c) { return c.method == method; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), {method, {}, {}});
        curve->points.push_back(&p);
    }
    for (AccuracyCurve& curve : curves) {
        std::stable_sort(curve.points.begin(), curve.points.end(), [](const auto* a, const auto* b) {
            return a->setting.steps_per_frame < b->setting.steps_per_frame;
        });
        for (std::size_t k = 1; k < curve.points.size(); ++k) {
            const AccuracyPoint &coarse = *curve.points[k - 1], &fine = *curve.points[k];
            if (coarse.broke || fine.broke || fine.error < clear_of_floor * floor) continue;
            const double halvings =
                std::log2(static_cast<double>(fine.setting.steps_per_frame) / coarse.setting.steps_per_frame);
            curve.order = std::log2(coarse.error / fine.error) / halvings;
        }
    }
    return curves;
}

std::string processor_of_most(const std::vector<AccuracyPoint>& points) {
    std::map<std::string, int> counts;
    for (const AccuracyPoint& p : points) {
        if (!p.broke) ++counts[p.processor];
    }
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == counts.end() ? std::string() : most->first;
}

std::string leave_out_other_processors(std::vector<AccuracyPoint>& points) {
    const std::string processor = processor_of_most(points);
    std::map<std::string, std::set<std::string>> others;  // processor → nodes
    const std::size_t all = points.size();
    std::erase_if(points, [&](const AccuracyPoint& p) {
        if (p.broke || p.processor == processor) return false;
        others[p.processor].insert(p.node);
        return true;
    });
    if (others.empty()) return {};
    std::string text = fmt::format(
        "{} of {} points were not timed on '{}', as most were, and are left out: times of "
        "different processors make no front.",
        all - points.size(), all, processor);
    for (const auto& [name, nodes] : others)
        text += fmt::format("\n  '{}': {}", name, fmt::join(nodes, ", "));
    return text +
           "\nThe same command times them again; --partition or --sbatch=--constraint=... choose equal "
           "nodes.";
}

std::vector<const AccuracyPoint*> pareto_front(const std::vector<AccuracyPoint>& points) {
    std::vector<const AccuracyPoint*> sorted, front;
    for (const AccuracyPoint& p : points) {
        if (!p.broke) sorted.push_back(&p);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto* a, const auto* b) { return a->median() < b->median(); });
    for (const AccuracyPoint* p : sorted) {
        if (front.empty() || p->error < front.back()->error) front.push_back(p);
    }
    return front;
}

std::optional<double> seconds_at(const AccuracyCurve& curve, double error) {
    for (std::size_t k = 1; k < curve.points.size(); ++k) {
        const AccuracyPoint &a = *curve.points[k - 1], &b = *curve.points[k];
        if (a.broke || b.broke || a.error < error || b.error > error || a.error == b.error) continue;
        const double share = std::log(a.error / error) / std::log(a.error / b.error);
        return a.median() * std::pow(b.median() / a.median(), share);
    }
    return {};
}

std::string recommendation(const std::vector<AccuracyPoint>& points, double error, double seconds_simulated,
                           const Rate& fps) {
    const AccuracyPoint* best = cheapest_within(points, error, nullptr);
    if (!best) {
        const std::vector<const AccuracyPoint*> front = pareto_front(points);
        return fmt::format(
            "No setting tried stays within an error of {:.2g}; the best, {} with steps of {}, "
            "reaches {:.2g}.",
            error, front.empty() ? "none" : front.back()->setting.method(),
            front.empty() ? "-" : step_text(front.back()->setting, fps),
            front.empty() ? 0.0 : front.back()->error);
    }
    std::string text = fmt::format(
        "For an error of {:.2g} of the cloth's diagonal take {}: {:.3g} s for each second simulated, error "
        "{:.2g}.",
        error, how_to(best->setting, fps), best->median() / seconds_simulated, best->error);
    for (const Integrator rival : {Integrator::implicit, Integrator::explicit_}) {
        const AccuracyPoint* other = cheapest_within(points, error, &rival);
        if (rival == best->setting.integrator) continue;
        if (other) {
            text += fmt::format(" {} needs steps of {} and {:.1f} times the time.", integrator_name(rival),
                                step_text(other->setting, fps), other->median() / best->median());
        } else {
            text += fmt::format(" {} does not reach it at the steps tried.", integrator_name(rival));
        }
    }
    return text;
}

std::string accuracy_table(const std::vector<AccuracyPoint>& points, const AccuracyReference& reference,
                           double error, const Rate& fps) {
    std::string text = fmt::format("{:<36} {:>8} {:>10} {:>9} {:>9} {:>15} {:>4} {:>9}\n", "method", "step",
                                   "error", "order", "seconds", "(spread)", "runs", "RVM");
    const std::vector<const AccuracyPoint*> front = pareto_front(points);
    for (const AccuracyCurve& curve : curves_of(points, reference.floor)) {
        for (const AccuracyPoint* p : curve.points) {
            const bool last = p == curve.points.back(),
                       best = std::find(front.begin(), front.end(), p) != front.end();
            text += fmt::format("{:<36} {:>8} {:>10} {:>9} {:>9.3f} {:>15} {:>4} {:>9.2e}{}\n",
                                p == curve.points.front() ? curve.method : "",
                                step_text(fps, p->setting.steps_per_frame),
                                p->broke ? "broke" : fmt::format("{:.2e}", p->error),
                                last && curve.order ? fmt::format("{:.2f}", *curve.order) : "", p->median(),
                                fmt::format("{:.3f}-{:.3f}", p->fastest(), p->slowest()), p->seconds.size(),
                                static_cast<double>(p->rvm), best ? "  front" : "");
        }
        if (const auto s = seconds_at(curve, error))
            text += fmt::format("{:<36} {:>8} {:>10.2e} {:>9} {:>9.3f}\n", "", "between", error, "", *s);
    }
    return text;
}

}  // namespace unravel::tool
