// unravel accuracy SCENE: which integrator, step, threshold and tolerance is cheapest for the error one can
// bear.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "sim/scene/load.hpp"
#include "tool/interrupt.hpp"
#include "tool/options.hpp"
#include "tool/progress.hpp"
#include "tool/run_folder.hpp"
#include "tool/studies/accuracy_verdict.hpp"

namespace unravel {

namespace {

// Shares of the budget: for the reference, and until which every point is to have run once.
constexpr double reference_share = 0.25, first_runs_share = 0.7;
constexpr std::size_t wanted_runs = 5;
// Points this much dearer than the front's at their error are timed once.
constexpr double near_front = 4;
constexpr std::size_t largest_csv = std::size_t{1} << 26;

class Study {
public:
    Study(const Options& options)
        : options_(options),
          scene_(load_scene(options.scene, options.overrides)),
          root_(options.output.empty() ? std::filesystem::path("output") / (scene_.name + "_accuracy")
                                       : options.output) {
        std::filesystem::create_directories(root_);
        const std::string as_run = scene_to_toml(scene_);
        const bool same = std::filesystem::exists(root_ / "scene.toml") &&
                          read_whole_text(root_ / "scene.toml", largest_csv) == as_run;
        resumed_ = same && !options.force && std::filesystem::exists(root_ / "reference.bin");
        if (resumed_ && std::filesystem::exists(csv()))
            points_ = read_accuracy_csv(read_whole_text(csv(), largest_csv));
        if (!resumed_) {
            std::filesystem::remove(csv());
            std::filesystem::remove(root_ / "reference.bin");
        }
        write_whole_file(root_ / "scene.toml", as_run);
    }

    int run() {
        const auto keep_on = [] { return !InterruptWatch::requested(); };
        if (resumed_) {
            std::size_t particles = 0;
            for (const Cloth& cloth : scene_.cloths)
                particles += static_cast<std::size_t>(cloth.particles[0]) *
                             static_cast<std::size_t>(cloth.particles[1]);
            reference_ = read_reference(root_ / "reference.bin", particles);
        } else {
            if (!options_.quiet) fmt::print(stderr, "{}: computing the reference ...\n", scene_.name);
            reference_ = make_reference(scene_, reference_share * budget(), keep_on);
            if (InterruptWatch::requested()) return exit_interrupted;
            write_whole_file(root_ / "reference.bin", reference_bytes(reference_));
        }
        if (!options_.quiet) {
            fmt::print(stderr, "reference: {} at 1/{} s, confirmed to {:.2e} by {} over {:.2f} s\n",
                       reference_.first.method(), reference_.first.steps_per_frame * scene_.clip.fps,
                       reference_.floor, reference_.second.method(), window());
        }
        run_all_once();
        repeat();
        conclude();
        return InterruptWatch::requested() ? exit_interrupted : exit_done;
    }

private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path csv() const { return root_ / "accuracy.csv"; }
    double budget() const { return 60 * options_.budget; }
    double spent() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    double window() const { return static_cast<double>(reference_.frames) / scene_.clip.fps; }

    AccuracyPoint* find(const AccuracySetting& setting) {
        const auto found = std::find_if(points_.begin(), points_.end(),
                                        [&](const AccuracyPoint& p) { return p.setting == setting; });
        return found == points_.end() ? nullptr : &*found;
    }

    // A method's next finer run takes at most about twice the last one's time.
    double estimate(const AccuracySetting& setting) const {
        double best = 0;
        for (const AccuracyPoint& p : points_) {
            if (p.setting.integrator != setting.integrator) continue;
            best = p.median() * setting.steps_per_frame / p.setting.steps_per_frame;
            if (p.setting.method() == setting.method()) return best;
        }
        return best;
    }

    std::optional<AccuracyPoint> measure(const AccuracySetting& setting) {
        AccuracyRun run =
            run_setting(scene_, setting, reference_.frames, [] { return !InterruptWatch::requested(); });
        if (run.stopped) return {};
        run.point.error = distance(run.trajectory, reference_.trajectory, diagonal_of(scene_));
        run.point.broke = run.point.broke || !(run.point.error < 1);
        return std::move(run.point);
    }

    void run_all_once() {
        const std::vector<AccuracySetting> grid = accuracy_grid(reference_);
        Progress progress(scene_.name + " once", static_cast<int>(grid.size()), options_.quiet);
        int done = 0, free = 0;
        for (const AccuracySetting& setting : grid) {
            if (InterruptWatch::requested()) break;
            progress.show(done++, free);
            if (find(setting)) {
                ++free;
                continue;
            }
            if (spent() + estimate(setting) > first_runs_share * budget()) {
                ++skipped_;
                continue;
            }
            if (std::optional<AccuracyPoint> point = measure(setting)) {
                points_.push_back(std::move(*point));
                write_whole_file(csv(), accuracy_csv(points_));
            }
        }
        progress.finish();
    }

    // Interleaved: each round times every point once, so that a busy spell of the machine falls on all.
    void repeat() {
        std::vector<std::size_t> worth;
        const std::vector<const AccuracyPoint*> front = pareto_front(points_);
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const AccuracyPoint& p = points_[k];
            if (p.broke) continue;
            double best = p.median();
            for (const AccuracyPoint* f : front) {
                if (f->error <= p.error) best = std::min(best, f->median());
            }
            if (p.median() <= near_front * best || p.setting.plain()) worth.push_back(k);
        }
        Progress progress(scene_.name + " timing", static_cast<int>(wanted_runs * worth.size()),
                          options_.quiet);
        int done = static_cast<int>(worth.size());
        const int free = done;
        for (std::size_t round = 2; round <= wanted_runs; ++round) {
            for (const std::size_t k : worth) {
                progress.show(done++, free);
                if (InterruptWatch::requested()) break;
                if (points_[k].seconds.size() >= round || spent() + points_[k].median() > budget()) continue;
                if (const std::optional<AccuracyPoint> again = measure(points_[k].setting))
                    points_[k].seconds.push_back(again->seconds.front());
            }
            write_whole_file(csv(), accuracy_csv(points_));
        }
        progress.finish();
    }

    void conclude() {
        const auto draw = [&](CostAxis axis, const std::string& name) {
            const Plot plot = accuracy_plot(points_, reference_, scene_.name, window(), axis);
            write_whole_file(root_ / (name + ".svg"), plot_svg(plot));
            write_png(root_ / (name + ".png"), plot_image(plot));
        };
        draw(CostAxis::time, "accuracy");
        draw(CostAxis::rvm, "accuracy_rvm");
        write_whole_file(root_ / "accuracy.html", accuracy_page(points_, reference_, scene_.name, window(),
                                                                scene_.clip.fps, options_.error));
        const std::string sentence = recommendation(points_, options_.error, window(), scene_.clip.fps);
        if (options_.json) {
            nlohmann::ordered_json json{{"scene", scene_.name},      {"points", points_.size()},
                                        {"skipped", skipped_},       {"window_seconds", window()},
                                        {"floor", reference_.floor}, {"recommendation", sentence},
                                        {"folder", root_.string()}};
            fmt::print("{}\n", json.dump(2));
        } else if (!options_.quiet) {
            fmt::print("{}\n{}\n", accuracy_table(points_, reference_, options_.error, scene_.clip.fps),
                       sentence);
            if (skipped_ > 0)
                fmt::print("{} settings did not fit the budget; the same command goes on with them\n",
                           skipped_);
            fmt::print("  {}\n  {}\n", (root_ / "accuracy.html").string(), csv().string());
        }
    }

    const Options& options_;
    Scene scene_;
    std::filesystem::path root_;
    AccuracyReference reference_;
    std::vector<AccuracyPoint> points_;
    bool resumed_ = false;  ///< the folder held a study of this very scene
    int skipped_ = 0;
    Clock::time_point start_ = Clock::now();
};

}  // namespace

int command_accuracy(const Options& options) {
    const InterruptWatch watch;
    const int threads = options.threads > 0
                            ? options.threads
                            : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
    return Study(options).run();
}

}  // namespace unravel
