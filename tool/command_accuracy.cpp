// unravel accuracy SCENE: which integrator, step, threshold and tolerance is cheapest for the error one can
// bear.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "render/video.hpp"
#include "sim/scene/load.hpp"
#include "tool/interrupt.hpp"
#include "tool/options.hpp"
#include "tool/studies/accuracy_contrast.hpp"
#include "tool/studies/accuracy_study.hpp"
#include "tool/studies/accuracy_verdict.hpp"
#include "tool/studies/accuracy_video.hpp"

namespace unravel {

namespace {

// Share of the budget that the video's two runs may take.
constexpr double video_share = 0.1;

bool keep_on() {
    return !InterruptWatch::requested();
}

void draw(const AccuracyStudy& study, CostAxis axis, const std::filesystem::path& stem) {
    const Plot plot = accuracy_plot(study.points, study.reference, study.scene.name, study.window(), axis);
    write_whole_file(stem.string() + ".svg", plot_svg(plot));
    write_png(stem.string() + ".png", plot_image(plot));
}

std::string caption_of(const AccuracyPoint& point, const AccuracyStudy& study) {
    return fmt::format("{}, steps of 1/{} s: {:.2g} s per second", point.setting.method(),
                       point.setting.steps_per_frame * study.scene.clip.fps, point.median() / study.window());
}

// The cheapest setting within the error beside the most accurate one, as far into the clip as the budget
// allows. Empty where there is nothing to compare or nothing to draw with.
std::string make_video(const AccuracyStudy& study, const Options& options, double budget,
                       const std::filesystem::path& file) {
    const std::vector<const AccuracyPoint*> front = pareto_front(study.points);
    if (front.size() < 2) return "";
    const AccuracyPoint* accurate = front.back();
    const AccuracyPoint* cheap = front.front();
    for (const AccuracyPoint* p : front) {
        if (p != accurate && p->error <= options.error) {
            cheap = p;
            break;
        }
    }
    const double per_frame = (cheap->median() + accurate->median()) / study.reference.frames;
    const int frames =
        std::clamp(static_cast<int>(video_share * budget / std::max(per_frame, 1e-6)), study.reference.frames,
                   std::max(study.scene.clip.frames() - 1, study.reference.frames));
    const auto side = [&](const AccuracyPoint& point) {
        return AccuracySide{run_setting(study.scene, point.setting, frames, keep_on).trajectory,
                            caption_of(point, study)};
    };
    try {
        write_accuracy_video(study.scene, side(*cheap), side(*accurate), parse_device_choice(options.device),
                             file, keep_on);
    } catch (const RendererError& error) {
        fmt::print(stderr, "no video: {}\n", error.what());
        return "";
    } catch (const VideoError& error) {
        fmt::print(stderr, "no video: {}\n", error.what());
        return "";
    }
    return file.string();
}

// One scene's study with its plots and its page.
AccuracyStudy study_scene(const Scene& scene, const std::filesystem::path& folder, double seconds,
                          const Options& options) {
    AccuracyStudy study = study_accuracy(scene, folder, {seconds, options.force, options.quiet}, keep_on);
    if (study.points.empty()) return study;
    draw(study, CostAxis::time, folder / "accuracy");
    draw(study, CostAxis::rvm, folder / "accuracy_rvm");
    write_whole_file(folder / "accuracy.html", accuracy_page(study.points, study.reference, scene.name,
                                                             study.window(), scene.clip.fps, options.error));
    if (options.quiet || options.json) return study;
    fmt::print("{}\n{}\n", accuracy_table(study.points, study.reference, options.error, scene.clip.fps),
               recommendation(study.points, options.error, study.window(), scene.clip.fps));
    if (study.skipped > 0)
        fmt::print("{} settings did not fit the budget; the same command goes on with them\n", study.skipped);
    return study;
}

nlohmann::ordered_json summary(const AccuracyStudy& study, const Options& options) {
    return {{"scene", study.scene.name},
            {"points", study.points.size()},
            {"skipped", study.skipped},
            {"window_seconds", study.window()},
            {"floor", study.reference.floor},
            {"recommendation",
             recommendation(study.points, options.error, study.window(), study.scene.clip.fps)}};
}

void print_files(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) fmt::print("  {}\n", file.string());
}

}  // namespace

int command_accuracy(const Options& options) {
    const InterruptWatch watch;
    const int threads = options.threads > 0
                            ? options.threads
                            : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
    const Scene scene = load_scene(options.scene, options.overrides);
    const std::filesystem::path root = options.output.empty()
                                           ? std::filesystem::path("output") / (scene.name + "_accuracy")
                                           : options.output;
    const bool film = options.video != "none", contrast = options.stiffer > 0;
    const double whole = 60 * options.budget,
                 each = whole * (film ? 1 - video_share : 1) / (contrast ? 2 : 1);

    const AccuracyStudy study = study_scene(scene, root, each, options);
    if (study.points.empty()) return exit_interrupted;
    std::vector<std::filesystem::path> files{root / "accuracy.html", root / "accuracy.png",
                                             root / "accuracy.csv"};
    nlohmann::ordered_json json = summary(study, options);
    json["folder"] = root.string();
    if (film && keep_on()) {
        const std::string video = make_video(study, options, whole, root / "cheap_and_accurate.mp4");
        json["video"] = video;
        if (!video.empty()) files.emplace_back(video);
    }
    if (contrast && keep_on()) {
        const AccuracyStudy stiff =
            study_scene(stiffened(scene, options.stiffer), root / "stiffer", each, options);
        if (!stiff.points.empty()) {
            const std::string words = contrast_words(study, stiff, options.stiffer);
            const std::array<Plot, 2> plots = contrast_plots(study, stiff, options.stiffer);
            write_whole_file(root / "soft_and_stiff.svg", plots_svg(plots));
            write_png(root / "soft_and_stiff.png", plots_image(plots));
            write_whole_file(root / "soft_and_stiff.html", contrast_page(study, stiff, options.stiffer));
            json["stiffer"] = summary(stiff, options);
            json["soft_and_stiff"] = words;
            if (!options.quiet && !options.json)
                fmt::print("{}\n{}\n{}\n", winner_table(study), winner_table(stiff), words);
            files.push_back(root / "soft_and_stiff.html");
        }
    }
    if (options.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.quiet) {
        print_files(files);
    }
    return keep_on() ? exit_done : exit_interrupted;
}

}  // namespace unravel
