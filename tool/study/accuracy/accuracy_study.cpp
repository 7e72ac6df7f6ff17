#include "tool/study/accuracy/accuracy_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tool/base/machine.hpp"
#include "tool/base/progress.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"

namespace unravel::tool {

namespace {

// Shares of the budget: for the reference, and until which every point is to have run once.
constexpr double reference_share = 0.25, first_runs_share = 0.7;
// Points this much dearer than the front's at their error are timed once.
constexpr double near_front = 4;

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
        if (folder_.holds_study()) {
            study_ = folder_.read();
        } else {
            if (!budget_.quiet) fmt::print(stderr, "{}: computing the reference ...\n", study_.scene.name);
            study_.reference = make_reference(study_.scene, reference_share * budget_.seconds, keep_on_);
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
            repeat();
        }
        study_.stopped = !keep_on_();
        return std::move(study_);
    }

private:
    using Clock = std::chrono::steady_clock;

    double spent() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    // s, of everything: it ends with its budget, or before.
    double left() const { return std::max(0.0, budget_.seconds - spent()) + budget_.after; }

    // A method's next finer run takes at most about twice the last one's time.
    double estimate(const AccuracySetting& setting) const {
        double best = 0;
        for (const AccuracyPoint& p : study_.points) {
            if (p.setting.integrator != setting.integrator) continue;
            best = p.median() * setting.steps_per_frame / p.setting.steps_per_frame;
            if (p.setting.method() == setting.method()) return best;
        }
        return best;
    }

    void run_all_once() {
        const std::vector<AccuracySetting> grid = accuracy_grid(study_.reference);
        Progress progress(study_.scene.name + " once", static_cast<int>(grid.size()), budget_.quiet, "point");
        int done = 0, free = 0;
        for (const AccuracySetting& setting : grid) {
            if (!keep_on_()) break;
            progress.show(done++, free, left());
            if (study_.find(setting)) {
                ++free;
                continue;
            }
            if (spent() + estimate(setting) > first_runs_share * budget_.seconds) {
                ++study_.skipped;
                continue;
            }
            if (std::optional<AccuracyPoint> point = measure_point(study_, setting, keep_on_)) {
                study_.points.push_back(std::move(*point));
                folder_.save_points(study_.points);
            }
        }
        progress.finish();
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
    AccuracyRun run = run_setting(study.scene, setting, study.reference.frames, keep_on);
    if (run.stopped) return {};
    run.point.node = host_name();
    run.point.processor = processor_name();
    run.point.error = distance(run.trajectory, study.reference.trajectory, diagonal_of(study.scene));
    run.point.broke = run.point.broke || !(run.point.error < 1);
    return std::move(run.point);
}

}  // namespace unravel::tool
