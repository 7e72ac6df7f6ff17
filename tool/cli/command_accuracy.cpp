// unravel accuracy SCENE: which integrator, step, threshold and tolerance is cheapest for the error one can
// bear.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "render/video.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/study/accuracy/accuracy_contrast.hpp"
#include "tool/study/accuracy/accuracy_points.hpp"
#include "tool/study/accuracy/accuracy_study.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"
#include "tool/study/accuracy/accuracy_video.hpp"

namespace unravel::tool {

namespace {

struct AccuracyOptions {
    std::filesystem::path scene, folder;
    std::vector<std::string> overrides;
    double budget = 10;   // minutes
    double error = 1e-3;  // to be borne, of the cloth's diagonal
    double stiffer = 0;   // also a cloth so many times stiffer; 0: not
    std::string window;   // A-B, s; empty: chosen
    std::string video = "mp4";
    std::string device = "auto";
    int threads = 0;
    bool force = false;
    bool reference = false;  // compute it, no point
    PieceOptions pieces;
    std::vector<std::string> words;  // the command line as it was written
    OutputOptions output;
};

// Share of the budget that the video's two runs may take.
constexpr double video_share = 0.1;

bool keep_on() {
    return !InterruptWatch::requested();
}

void draw(const AccuracyStudy& study, CostAxis axis, const std::filesystem::path& stem) {
    const Plot plot = accuracy_plot(study.points, study.reference, study.scene.name, study.window(),
                                    study.scene.clip.fps, axis);
    write_whole_file(stem.string() + ".svg", plot_svg(plot));
    write_png(stem.string() + ".png", plot_image(plot));
}

std::string caption_of(const AccuracyPoint& point, const AccuracyStudy& study) {
    return fmt::format("{}, steps of {} s: {:.2g} s per second", point.setting.method(),
                       step_text(study.scene.clip.fps, point.setting.steps_per_frame),
                       point.median() / study.window());
}

// The cheapest setting within the error beside the most accurate one, as far into the clip as the budget
// allows. Empty where there is nothing to compare or nothing to draw with.
std::string make_video(const AccuracyStudy& study, const AccuracyOptions& options, double budget,
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
        const AccuracyReference& reference = study.reference;
        const double t0 = study.scene.clip.fps.time_of(reference.first_frame);
        return AccuracySide{
            run_setting(study.scene, point.setting, frames, keep_on, reference.start, t0).trajectory,
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

// The plots and the page of a study, and what it says in words. False: points had to be left out of it,
// because they were timed on another processor than most.
bool conclude(AccuracyStudy& study, const std::filesystem::path& folder, const AccuracyOptions& options) {
    const std::string left_out = leave_out_other_processors(study.points);
    draw(study, CostAxis::time, folder / "accuracy");
    draw(study, CostAxis::rvm, folder / "accuracy_rvm");
    const Scene& scene = study.scene;
    write_whole_file(folder / "accuracy.html", accuracy_page(study.points, study.reference, scene.name,
                                                             study.window(), scene.clip.fps, options.error));
    if (!left_out.empty()) fmt::print(stderr, "unravel: {}\n", left_out);
    if (!options.output.talks()) return left_out.empty();
    fmt::print("{}\n{}\n", accuracy_table(study.points, study.reference, options.error, scene.clip.fps),
               recommendation(study.points, options.error, study.window(), scene.clip.fps));
    if (study.skipped > 0)
        fmt::print("{} settings did not fit the budget; the same command goes on with them\n", study.skipped);
    return left_out.empty();
}

nlohmann::ordered_json summary(const AccuracyStudy& study, const AccuracyOptions& options) {
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

// "0.5-1.2", seconds of the clip, as its frames.
AccuracyWindow window_of(const std::string& text, const Scene& scene) {
    if (text.empty()) return {};
    double from = 0, to = 0;
    const std::size_t dash = text.find('-');
    const auto number = [&](std::size_t begin, std::size_t end, double& out) {
        const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, out);
        return error == std::errc() && rest == text.data() + end;
    };
    const bool pair = dash != text.npos && number(0, dash, from) && number(dash + 1, text.size(), to);
    AccuracyWindow window{static_cast<int>(std::lround(from * scene.clip.fps.per_second())), {}};
    const int last = static_cast<int>(std::lround(to * scene.clip.fps.per_second()));
    if (!pair || from < 0 || last <= window.first || last >= scene.clip.frames())
        throw UsageError(fmt::format("--window {}: write it as A-B in seconds within 0-{:g}", text,
                                     scene.clip.fps.time_of(scene.clip.frames() - 1)));
    window.last = last;
    return window;
}

int accuracy(const AccuracyOptions& options) {
    const InterruptWatch watch;
    const int threads = thread_count(options.threads);
    const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
    const Scene scene = load_scene(options.scene, options.overrides);
    const std::filesystem::path root = options.folder.empty()
                                           ? std::filesystem::path("output") / (scene.name + "_accuracy")
                                           : options.folder;
    const bool film = options.video != "none", contrast = options.stiffer > 0;
    const double whole = 60 * options.budget,
                 each = whole * (film ? 1 - video_share : 1) / (contrast ? 2 : 1);
    AccuracyBudget budget{each, options.force, options.output.quiet};
    budget.error = options.error;
    budget.window = window_of(options.window, scene);
    budget.after = (film ? video_share * whole : 0) + (contrast ? each : 0);

    const PieceOptions& pieces = options.pieces;
    if (!pieces.whole() || options.reference) {
        if (contrast)
            throw UsageError("--stiffer compares two studies on one machine: a cluster takes one at a time");
        if (pieces.cluster.submit) {
            ClusterWork work = accuracy_cluster_work(scene, root, options.force);
            work.words = options.words;
            work.threads = options.threads == 0;
            return do_on_cluster(pieces.cluster, options.output, work);
        }
        if (options.reference)
            return study_reference(scene, root, budget, keep_on) ? exit_done : InterruptWatch::exit_code();
        if (pieces.point >= 0)
            return time_accuracy_point(scene, root, pieces.point, keep_on) ? exit_done
                                                                           : InterruptWatch::exit_code();
    }

    std::string missing;
    AccuracyStudy study = pieces.collect ? collect_accuracy(scene, root, missing)
                                         : study_accuracy(scene, root, budget, keep_on);
    if (study.points.empty() && missing.empty()) {
        if (!keep_on()) return InterruptWatch::exit_code();
        fmt::print(stderr,
                   "unravel: {:g} minutes ended before one point was timed; the same command goes on, with "
                   "--budget for more at once\n",
                   options.budget);
        return exit_simulation;
    }
    const bool same_processor = study.points.empty() || conclude(study, root, options);
    if (!missing.empty())
        throw MissingPieces("points are missing:" + missing +
                            "\nthe same command sends them again and keeps the rest");
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
        budget.after = 0;
        AccuracyStudy stiff =
            study_accuracy(stiffened(scene, options.stiffer), root / "stiffer", budget, keep_on);
        if (!stiff.points.empty()) {
            conclude(stiff, root / "stiffer", options);
            const std::string words = contrast_words(study, stiff, options.stiffer);
            const std::array<Plot, 2> plots = contrast_plots(study, stiff, options.stiffer);
            write_whole_file(root / "soft_and_stiff.svg", plots_svg(plots));
            write_png(root / "soft_and_stiff.png", plots_image(plots));
            write_whole_file(root / "soft_and_stiff.html", contrast_page(study, stiff, options.stiffer));
            json["stiffer"] = summary(stiff, options);
            json["soft_and_stiff"] = words;
            if (options.output.talks())
                fmt::print("{}\n{}\n{}\n", winner_table(study), winner_table(stiff), words);
            files.push_back(root / "soft_and_stiff.html");
        }
    }
    if (options.output.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.output.quiet) {
        print_files(files);
    }
    if (!keep_on()) return InterruptWatch::exit_code();
    return same_processor ? exit_done : exit_simulation;
}

}  // namespace

void add_accuracy(CommandLine& line) {
    const auto [command, o] = line.add(
        "accuracy", "what accuracy costs in time: integrators, steps, thresholds and tolerances", accuracy);
    o.words = line.words();
    command.add_option("SCENE", o.scene, "scene file")->required();
    command.add_option("-o", o.folder, "folder of the study (default: output/<scene name>_accuracy)");
    add_overrides(command, o.overrides);
    command.add_option("--budget", o.budget, "minutes that the study may take")
        ->check(CLI::Range(0.1, 1e5))
        ->capture_default_str();
    command.add_option("--error", o.error, "to be borne, as a share of the cloth's diagonal")
        ->check(CLI::Range(1e-9, 1.0))
        ->capture_default_str();
    command
        .add_option("--stiffer", o.stiffer,
                    "the same study of a cloth so many times stiffer, and both side by side")
        ->check(CLI::Range(1.0, 1e6));
    command.add_option(
        "--window", o.window,
        "A-B: seconds of the clip that are compared (default: from its start, until references part)");
    command.add_option("--video", o.video, "mp4 of a cheap run beside an accurate one, or none")
        ->check(CLI::IsMember({"mp4", "none"}))
        ->capture_default_str();
    add_device(command, o.device);
    add_threads(command, o.threads);
    command.add_flag("--force", o.force, "forget the points of an earlier study in the folder");
    add_piece_options(command, o.pieces);
    command.add_flag("--reference", o.reference, "compute the reference, no point")->group("On a cluster");
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
