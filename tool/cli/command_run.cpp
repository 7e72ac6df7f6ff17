// unravel run SCENE ... and unravel simulate SCENE ...: the main job, with and without pictures.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>

#include "base/whole_file.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/step/explicit_limit.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/scene_list.hpp"
#include "tool/folder/folder_lock.hpp"
#include "tool/picture/clip.hpp"
#include "tool/report/page.hpp"
#include "tool/run/draft.hpp"
#include "tool/run/failure_bundle.hpp"
#include "tool/run/run_json.hpp"
#include "tool/run/run_source.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

// Threads beyond the simulation's own: drawing, writing and encoding wait on other things for much of their
// time.
constexpr int pipeline_threads = 3;

void print_summary(const OutputOptions& options, const RunFolder& folder,
                   const nlohmann::ordered_json& json) {
    if (options.json) {
        fmt::print("{}\n", json.dump(2));
        return;
    }
    if (options.quiet) return;
    const auto& totals = json["totals"];
    fmt::print("{}: {} frames, {} steps, {} particles", json["status"].get<std::string>(),
               json["frames"].get<int>(), json["steps"].get<int>(), json["particles"].get<int>());
    if (totals.contains("rvm_saved"))
        fmt::print(", {:.1f}% fewer RVMs than whole", 100 * totals["rvm_saved"].get<double>());
    fmt::print("\n");
    for (const auto& warning : json["warnings"]) fmt::print("  note: {}\n", warning.get<std::string>());
    if (json.contains("videos")) {
        for (const auto& video : json["videos"])
            fmt::print("  {}\n", (folder.root / video.get<std::string>()).string());
    }
    fmt::print("  {}\n  {}\n", folder.stats().string(), folder.report().string());
}

// What a draft left is worth no question.
bool is_draft(const RunFolder& folder) {
    const nlohmann::ordered_json run = read_run_json(folder);
    return run.contains("draft") && run["draft"] == true;
}

int make_run(const fs::path& file, const RunOptions& options, bool pictures) {
    const auto begin = std::chrono::steady_clock::now();
    Scene scene = load_scene(file, options.overrides);
    if (options.draft) scene = draft_of(std::move(scene));
    const std::string folder_name = scene.name + (options.draft ? "_draft" : "");
    const RunFolder folder{options.folder.empty() ? fs::path("output") / folder_name : options.folder};
    ClipOptions clip_options = clip_options_of(options.pictures, scene);
    clip_options.textures = scene.home;
    Simulation simulation = start_simulation(scene);
    simulation.options.compare_whole = options.compare_whole;
    if (!options.allow_unstable)
        require_explicit_stability(simulation.model, simulation.options, scene.solver.step);
    if (pictures) check_clip(scene, folder, clip_options);

    // Until here a signal ends the program: there is nothing to finish.
    const InterruptWatch watch;
    const FolderLock lock(folder.root);
    const Existing existing = options.force      ? Existing::replace
                              : options.resume   ? Existing::resume
                              : is_draft(folder) ? Existing::replace
                                                 : usual_existing(folder, scene);
    const bool goes_on = existing == Existing::resume && !options.resume && fs::exists(folder.record(0));
    if (goes_on && !options.output.quiet)
        fmt::print(stderr, "{}: going on with what an unfinished run left in {}\n", scene.name,
                   folder.root.string());
    const std::uint64_t hash = open_run(folder, scene, existing, clip_options.textures);

    const int threads = thread_count(options.threads);
    const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads + pipeline_threads));
    const int cached =
        cached_frames(folder, scene, hash, simulation.model.size(), simulation.model.springs.size());
    clip_options.reuse_pictures = existing == Existing::resume;
    RunSource source(scene, folder, hash, simulation, cached, threads);
    PageRecorder recorder(simulation.model, folder.root);
    Previews previews = previews_of(scene, clip_options, folder.root);
    if (pictures) {
        clip_options.picture = take_previews(previews);
    }
    // A run that can't go on ends its clip as one that was stopped does: what it has is kept.
    std::optional<SimulationError> failure;
    const FrameSource next = [&]() -> std::optional<FrameRecord> {
        // Nothing beyond the last frame asked for is computed.
        if (static_cast<int>(recorder.frames().size()) > clip_options.last) return std::nullopt;
        try {
            std::optional<FrameRecord> record = source.next();
            if (record) recorder.add(*record);
            return record;
        } catch (const SimulationError& error) {
            failure = error;
            return std::nullopt;
        }
    };

    // Frames before those asked for are simulated too.
    Progress progress(scene.name, std::min(scene.clip.frames(), clip_options.last + 1), options.output.quiet);
    const auto done = [&](int frame) { progress.show(frame + 1, std::min(cached, frame + 1)); };
    std::optional<ClipReport> report;
    const auto conclude = [&](const char* status) {
        progress.finish();
        source.write_stats();
        nlohmann::ordered_json json =
            run_json(scene, simulation, source, threads, status, report ? &*report : nullptr);
        json["command"] = command_of_run(options);
        if (options.draft) json["draft"] = true;
        json["wall_seconds"] =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        write_whole_file(folder.run_json(), json.dump(2) + "\n");
        write_report_page(scene, simulation.model, folder, recorder, source.reports(), previews,
                          page_facts(json));
        print_summary(options.output, folder, json);
        if (report && !report->kept.empty() && options.output.talks()) fmt::print("  {}\n", report->kept);
    };
    if (pictures) {
        Placement placement;
        build_model(scene, placement);
        report = make_clip(scene, simulation.model, placement, folder, clip_options, next, done);
    } else {
        while (const std::optional<FrameRecord> record = next()) done(record->frame);
    }
    if (failure) {
        write_failure(folder, scene, hash, simulation, *failure, clip_options);
        conclude("failed");
        throw *failure;
    }
    conclude(InterruptWatch::requested() ? "interrupted" : "complete");
    return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
}

int run(const RunOptions& options) {
    return for_each_scene(
        options, [](const fs::path& scene, const RunOptions& one) { return make_run(scene, one, true); });
}

int simulate(const RunOptions& options) {
    return for_each_scene(
        options, [](const fs::path& scene, const RunOptions& one) { return make_run(scene, one, false); });
}

void add_run_options(const CommandLine& line, CLI::App& command, RunOptions& o) {
    o.words = line.words();
    command
        .add_option("SCENE", o.scenes, "scene files, each made into a clip of its own; - is standard input")
        ->required();
    command.add_option(
        "-o", o.folder,
        "folder of the run (default: output/<scene name>); of several scenes, the folder around theirs");
    add_overrides(command, o.overrides);
    add_threads(command, o.threads);
    command.add_flag("--resume", o.resume, "go on from the last frame in the folder");
    command.add_flag("--force", o.force, "start anew in a folder that holds a run");
    command.add_flag("--draft", o.draft,
                     "coarse and quick, into output/<scene name>_draft, as often as you like");
    command.add_flag("--allow-unstable", o.allow_unstable,
                     "simulate although the step is beyond the limit of the springs handled explicitly");
    command.add_flag("--compare-whole", o.compare_whole,
                     "solve each system undecomposed too, and count rvm_whole");
    add_piece_options(command, o.pieces);
    add_output_options(command, o.output);
}

}  // namespace

void add_run(CommandLine& line) {
    const auto [command, o] = line.add("run", "simulate, render both views, encode", run);
    add_run_options(line, command, o);
    add_picture_options(command, o.pictures);
    command.add_option("--still", o.pictures.still, "this frame alone, without a video")
        ->check(CLI::NonNegativeNumber);
}

void add_simulate(CommandLine& line) {
    const auto [command, o] = line.add("simulate", "simulate only, into a cache", simulate);
    add_run_options(line, command, o);
}

}  // namespace unravel::tool
