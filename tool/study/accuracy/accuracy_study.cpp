#include "tool/study/accuracy/accuracy_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "sim/step/explicit_limit.hpp"

#include "tool/base/machine.hpp"
#include "tool/base/progress.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"

namespace unravel::tool {

namespace {

// Shares of the budget: for the reference, and until which every point is to have run once.
constexpr double reference_share = 0.25, first_runs_share = 0.7;
// Points this much dearer than the front's at their error are timed once.
constexpr double near_front = 4;
// The cheapest may turn out to be another one when it is timed again, so often at most.
constexpr int most_verified = 3;

class Work {
public:
    Work(const Scene& scene, const std::filesystem::path& folder, const AccuracyBudget& budget,
         const std::function<bool()>& keep_on)
        : folder_(scene, folder, budget.force), budget_(budget), keep_on_(keep_on) {
        folder_.begin();
        study_.scene = scene;
    }

    // False: it was stopped.
    bool have_reference() {
        if (folder_.holds_study()) study_ = folder_.read();
        if (!folder_.holds_study() || !is_of(budget_.window)) {
            folder_.forget();
            study_.points.clear();
            if (!budget_.quiet) fmt::print(stderr, "{}: computing the reference ...\n", study_.scene.name);
            study_.reference =
                make_reference(study_.scene, budget_.window, reference_share * budget_.seconds, keep_on_);
            if (!keep_on_()) return false;
            folder_.save_reference(study_.reference);
        }
        const AccuracyReference& reference = study_.reference;
        if (!budget_.quiet) {
            fmt::print(stderr, "reference: {} at {} s, confirmed to {:.2e} by {} over {:.2f} s\n",
                       reference.first.method(),
                       step_text(study_.scene.clip.fps, reference.first.steps_per_frame), reference.floor,
                       reference.second.method(), study_.window());
        }
        return true;
    }

    AccuracyStudy run() {
        if (have_reference()) {
            run_all_once();
            verify();
            repeat();
        }
        study_.stopped = !keep_on_();
        return std::move(study_);
    }

private:
    // Whether the reference that was read is of this window.
    bool is_of(const AccuracyWindow& window) const {
        const AccuracyReference& reference = study_.reference;
        return reference.first_frame == window.first &&
               reference.asked == (window.last ? *window.last - window.first : 0);
    }

    using Clock = std::chrono::steady_clock;

    double spent() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    // s, of everything: it ends with its budget, or before.
    double left() const { return std::max(0.0, budget_.seconds - spent()) + budget_.after; }

    // From the point of the method, else of the integrator, else of any, that is nearest in steps: time grows
    // no faster than they do.
    double estimate(const AccuracySetting& setting) const {
        const AccuracyPoint* best = nullptr;
        const auto kinship = [&](const AccuracyPoint& p) {
            return p.broke                                      ? 0
                   : p.setting.method() == setting.method()     ? 3
                   : p.setting.integrator == setting.integrator ? 2
                                                                : 1;
        };
        for (const AccuracyPoint& p : study_.points) {
            if (kinship(p) > (best ? kinship(*best) : 0)) best = &p;
            if (best && kinship(p) == kinship(*best) &&
                p.setting.steps_per_frame > best->setting.steps_per_frame)
                best = &p;
        }
        if (!best) return 0;
        return best->median() *
               std::max(1.0, static_cast<double>(setting.steps_per_frame) / best->setting.steps_per_frame);
    }

    // Nothing that it could show is asked for: its method keeps within the error with longer steps already
    // (each integrator's own curve goes one further), or it is far dearer than what does.
    bool is_needless(const AccuracySetting& setting) const {
        int within = 0;
        double cheapest = std::numeric_limits<double>::infinity();
        for (const AccuracyPoint& p : study_.points) {
            if (p.broke || p.error > budget_.error) continue;
            cheapest = std::min(cheapest, p.median());
            if (p.setting.method() == setting.method() && p.setting.steps_per_frame < setting.steps_per_frame)
                ++within;
        }
        return within > (setting.plain() ? 1 : 0) || estimate(setting) > near_front * cheapest;
    }

    // Explicit steps too long to be stable blow up: the shortest of those shows it.
    void leave_out_unstable(std::vector<AccuracySetting>& settings) const {
        Placement placement;
        const ClothModel model = build_model(study_.scene, placement);
        StepOptions options = step_options(study_.scene.solver);
        options.integrator = Integrator::explicit_;
        options.substeps = 1;
        const AccuracySetting own = scene_setting(study_.scene);
        const auto blows_up = [&](const AccuracySetting& setting) {
            if (setting.integrator != Integrator::explicit_ || setting == own) return false;
            return explicit_limit(model, options,
                                  1.0 / (study_.scene.clip.fps.per_second() * setting.steps_per_frame))
                       .share > 1;
        };
        int most = 0;
        for (const AccuracySetting& setting : settings)
            if (blows_up(setting)) most = std::max(most, setting.steps_per_frame);
        std::erase_if(settings,
                      [&](const AccuracySetting& s) { return s.steps_per_frame < most && blows_up(s); });
    }

    // The scene's own setting first, then the cheapest by estimate: what is dear comes last, if at all.
    void run_all_once() {
        std::vector<AccuracySetting> open = accuracy_grid(study_.reference, study_.scene);
        leave_out_unstable(open);
        const auto all = static_cast<int>(open.size());
        std::erase_if(open, [&](const AccuracySetting& setting) { return study_.find(setting) != nullptr; });
        Progress progress(study_.scene.name + " once", all, budget_.quiet, "point");
        const int free = all - static_cast<int>(open.size());
        while (!open.empty() && keep_on_()) {
            progress.show(all - static_cast<int>(open.size()), free, left());
            const auto cheaper = [&](const AccuracySetting& a, const AccuracySetting& b) {
                return estimate(a) < estimate(b);
            };
            const auto next =
                study_.points.empty() ? open.begin() : std::min_element(open.begin(), open.end(), cheaper);
            const AccuracySetting setting = *next;
            open.erase(next);
            if (is_needless(setting)) continue;
            const double end = first_runs_share * budget_.seconds;
            // The scene's own is always tried: what is recommended in its place has to be cheaper than it.
            const bool own = study_.points.empty();
            if (!own && spent() + estimate(setting) > end) {
                ++study_.skipped;
                continue;
            }
            const std::function<bool()> in_time = [&] { return keep_on_() && (own || spent() < end); };
            if (std::optional<AccuracyPoint> point = measure_point(study_, setting, in_time)) {
                study_.points.push_back(std::move(*point));
                folder_.save_points(study_.points);
            } else {
                ++study_.skipped;
            }
        }
        progress.finish();
    }

    // What is recommended has been run at least twice.
    void verify() {
        for (int tries = 0; tries < most_verified && keep_on_(); ++tries) {
            AccuracyPoint* best = nullptr;
            for (AccuracyPoint& p : study_.points)
                if (!p.broke && p.error <= budget_.error && (!best || p.median() < best->median())) best = &p;
            if (!best || best->seconds.size() > 1) return;
            const std::optional<AccuracyPoint> again = measure_point(study_, best->setting, keep_on_);
            if (!again) return;
            best->seconds.push_back(again->seconds.front());
            folder_.save_points(study_.points);
        }
    }

    // Points whose time decides something: those near the front, and each method's own curve.
    std::vector<std::size_t> worth_timing() const {
        std::vector<std::size_t> worth;
        const std::vector<const AccuracyPoint*> front = pareto_front(study_.points);
        for (std::size_t k = 0; k < study_.points.size(); ++k) {
            const AccuracyPoint& p = study_.points[k];
            if (p.broke) continue;
            double best = p.median();
            for (const AccuracyPoint* f : front) {
                if (f->error <= p.error) best = std::min(best, f->median());
            }
            if (p.median() <= near_front * best || p.setting.plain()) worth.push_back(k);
        }
        return worth;
    }

    void repeat() {
        const std::vector<std::size_t> worth = worth_timing();
        Progress progress(study_.scene.name + " timing", static_cast<int>(wanted_runs * worth.size()),
                          budget_.quiet, "run");
        int done = static_cast<int>(worth.size());
        const int free = done;
        for (std::size_t round = 2; round <= wanted_runs; ++round) {
            for (const std::size_t k : worth) {
                progress.show(done++, free, left());
                if (!keep_on_()) break;
                AccuracyPoint& point = study_.points[k];
                if (point.seconds.size() >= round || spent() + point.median() > budget_.seconds) continue;
                std::optional<AccuracyPoint> again = measure_point(study_, point.setting, keep_on_);
                if (!again) continue;
                if (again->processor == point.processor) {
                    point.seconds.push_back(again->seconds.front());
                } else {
                    point = std::move(*again);  // times of two processors make no median
                }
            }
            folder_.save_points(study_.points);
        }
        progress.finish();
    }

    AccuracyFolder folder_;
    AccuracyBudget budget_;
    const std::function<bool()>& keep_on_;
    AccuracyStudy study_;
    Clock::time_point start_ = Clock::now();
};

}  // namespace

AccuracyStudy study_accuracy(const Scene& scene, const std::filesystem::path& folder,
                             const AccuracyBudget& budget, const std::function<bool()>& keep_on) {
    return Work(scene, folder, budget, keep_on).run();
}

bool study_reference(const Scene& scene, const std::filesystem::path& folder, const AccuracyBudget& budget,
                     const std::function<bool()>& keep_on) {
    return Work(scene, folder, budget, keep_on).have_reference();
}

std::optional<AccuracyPoint> measure_point(const AccuracyStudy& study, const AccuracySetting& setting,
                                           const std::function<bool()>& keep_on) {
    const AccuracyReference& reference = study.reference;
    AccuracyRun run = run_setting(study.scene, setting, reference.frames, keep_on, reference.start,
                                  study.scene.clip.fps.time_of(reference.first_frame));
    if (run.stopped) return {};
    run.point.node = host_name();
    run.point.processor = processor_name();
    run.point.error = distance(run.trajectory, study.reference.trajectory, diagonal_of(study.scene));
    run.point.broke = run.point.broke || !(run.point.error < 1);
    return std::move(run.point);
}

}  // namespace unravel::tool
