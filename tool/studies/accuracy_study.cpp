#include "tool/studies/accuracy_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/whole_file.hpp"
#include "sim/scene/load.hpp"
#include "tool/progress.hpp"
#include "tool/studies/accuracy_verdict.hpp"

namespace unravel {

namespace {

// Shares of the budget: for the reference, and until which every point is to have run once.
constexpr double reference_share = 0.25, first_runs_share = 0.7;
constexpr std::size_t wanted_runs = 5;
// Points this much dearer than the front's at their error are timed once.
constexpr double near_front = 4;
constexpr std::size_t largest_csv = std::size_t{1} << 26;

std::size_t particles_of(const Scene& scene) {
    std::size_t particles = 0;
    for (const Cloth& cloth : scene.cloths)
        particles +=
            static_cast<std::size_t>(cloth.particles[0]) * static_cast<std::size_t>(cloth.particles[1]);
    return particles;
}

class Work {
public:
    Work(const Scene& scene, const std::filesystem::path& folder, const AccuracyBudget& budget,
         const std::function<bool()>& keep_on)
        : folder_(folder), budget_(budget), keep_on_(keep_on) {
        study_.scene = scene;
        std::filesystem::create_directories(folder_);
        const std::string as_run = scene_to_toml(scene);
        const std::filesystem::path toml = folder_ / "scene.toml", reference = folder_ / "reference.bin";
        const bool same =
            std::filesystem::exists(toml) && read_whole_text(toml, largest_csv) == as_run && !budget.force;
        resumed_ = same && std::filesystem::exists(reference);
        if (resumed_ && std::filesystem::exists(csv()))
            study_.points = read_accuracy_csv(read_whole_text(csv(), largest_csv));
        if (!resumed_) {
            std::filesystem::remove(csv());
            std::filesystem::remove(reference);
        }
        write_whole_file(toml, as_run);
    }

    AccuracyStudy run() {
        AccuracyReference& reference = study_.reference;
        if (resumed_) {
            reference = read_reference(folder_ / "reference.bin", particles_of(study_.scene));
        } else {
            if (!budget_.quiet) fmt::print(stderr, "{}: computing the reference ...\n", study_.scene.name);
            reference = make_reference(study_.scene, reference_share * budget_.seconds, keep_on_);
            study_.stopped = !keep_on_();
            if (study_.stopped) return std::move(study_);
            write_whole_file(folder_ / "reference.bin", reference_bytes(reference));
        }
        if (!budget_.quiet) {
            fmt::print(stderr, "reference: {} at 1/{} s, confirmed to {:.2e} by {} over {:.2f} s\n",
                       reference.first.method(), reference.first.steps_per_frame * study_.scene.clip.fps,
                       reference.floor, reference.second.method(), study_.window());
        }
        run_all_once();
        repeat();
        study_.stopped = !keep_on_();
        return std::move(study_);
    }

private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path csv() const { return folder_ / "accuracy.csv"; }
    double spent() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    bool known(const AccuracySetting& setting) const {
        return std::any_of(study_.points.begin(), study_.points.end(),
                           [&](const AccuracyPoint& p) { return p.setting == setting; });
    }

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

    std::optional<AccuracyPoint> measure(const AccuracySetting& setting) {
        AccuracyRun run = run_setting(study_.scene, setting, study_.reference.frames, keep_on_);
        if (run.stopped) return {};
        run.point.error = distance(run.trajectory, study_.reference.trajectory, diagonal_of(study_.scene));
        run.point.broke = run.point.broke || !(run.point.error < 1);
        return std::move(run.point);
    }

    void save() { write_whole_file(csv(), accuracy_csv(study_.points)); }

    void run_all_once() {
        const std::vector<AccuracySetting> grid = accuracy_grid(study_.reference);
        Progress progress(study_.scene.name + " once", static_cast<int>(grid.size()), budget_.quiet);
        int done = 0, free = 0;
        for (const AccuracySetting& setting : grid) {
            if (!keep_on_()) break;
            progress.show(done++, free);
            if (known(setting)) {
                ++free;
                continue;
            }
            if (spent() + estimate(setting) > first_runs_share * budget_.seconds) {
                ++study_.skipped;
                continue;
            }
            if (std::optional<AccuracyPoint> point = measure(setting)) {
                study_.points.push_back(std::move(*point));
                save();
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
                          budget_.quiet);
        int done = static_cast<int>(worth.size());
        const int free = done;
        for (std::size_t round = 2; round <= wanted_runs; ++round) {
            for (const std::size_t k : worth) {
                progress.show(done++, free);
                if (!keep_on_()) break;
                AccuracyPoint& point = study_.points[k];
                if (point.seconds.size() >= round || spent() + point.median() > budget_.seconds) continue;
                if (const std::optional<AccuracyPoint> again = measure(point.setting))
                    point.seconds.push_back(again->seconds.front());
            }
            save();
        }
        progress.finish();
    }

    std::filesystem::path folder_;
    AccuracyBudget budget_;
    const std::function<bool()>& keep_on_;
    AccuracyStudy study_;
    bool resumed_ = false;  ///< the folder held a study of this very scene
    Clock::time_point start_ = Clock::now();
};

}  // namespace

AccuracyStudy study_accuracy(const Scene& scene, const std::filesystem::path& folder,
                             const AccuracyBudget& budget, const std::function<bool()>& keep_on) {
    return Work(scene, folder, budget, keep_on).run();
}

}  // namespace unravel
