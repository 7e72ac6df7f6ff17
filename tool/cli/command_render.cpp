// unravel render RUN_DIR: pictures and videos from a cached run, without simulating again.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "sim/run/simulate.hpp"
#include "sim/run/stats.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/options.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/frame_ranges.hpp"
#include "tool/cli/render_options.hpp"
#include "tool/cli/render_place.hpp"
#include "tool/folder/folder_lock.hpp"
#include "tool/picture/clip.hpp"
#include "tool/picture/turntable.hpp"
#include "tool/report/page.hpp"

namespace unravel::tool {

namespace {

// What the run left about itself; a run that was killed left nothing, and its page says less.
nlohmann::ordered_json earlier_run(const RunFolder& folder) {
    nlohmann::ordered_json run = read_run_json(folder);
    if (run.is_null()) run = {{"status", "unfinished"}};
    return run;
}

void print_files(const Options& options, const RunFolder& folder, const ClipOptions& clip_options,
                 const ClipReport& report) {
    if (options.quiet) return;
    for (const std::string& video : report.videos) fmt::print("  {}\n", (folder.root / video).string());
    if (!report.videos.empty() || !clip_options.keep_pictures) return;
    for (const ClipView& view : clip_options.views)
        fmt::print("  {}\n", folder.picture(view.name, clip_options.first).string());
}

// One turn about a frame that stands still; the run's page stays as it is.
int draw_turntable(const Options& options, const Scene& scene, const ClothModel& model,
                   const Placement& placement, const std::array<RunFolder, 2>& from_to,
                   const ClipOptions& clip_options, int frame, std::uint64_t hash) {
    const auto& [cached, folder] = from_to;
    const FrameRecord record = read_frame(cached, frame, hash, model.size(), model.springs.size());
    Progress progress(scene.name, clip_options.last + 1, options.quiet);
    const FrameSource turn = turntable_source(clip_options, record);
    const FrameSource source = [&]() -> std::optional<FrameRecord> {
        return InterruptWatch::requested() ? std::nullopt : turn();
    };
    const ClipReport report = make_clip(scene, model, placement, folder, clip_options, source,
                                        [&](int done) { progress.show(done + 1, 0); });
    progress.finish();
    print_files(options, folder, clip_options, report);
    return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
}

}  // namespace

int command_render(const Options& options) {
    const RunFolder cached{options.scene};
    if (!std::filesystem::exists(cached.scene())) {
        throw FolderError(fmt::format(
            "'{}' holds no run: it has no scene.toml; `unravel run SCENE` makes one", cached.root.string()));
    }
    Scene scene = load_scene(cached.scene(), options.overrides);
    const std::uint64_t hash = scene_hash(scene);
    const Scene as_run = scene;
    const nlohmann::ordered_json left = earlier_run(cached);
    // The folder's scene.toml has lost the name that the scene came by.
    scene.name = left.value("scene", (cached.root / "").parent_path().filename().string());
    ClipOptions clip_options = clip_options_of(options, scene);
    clip_options.textures = cached.root;
    const bool turns = options.turntable > 0;
    const int still = options.still >= 0 ? options.still : scene.clip.frames() - 1;
    if (turns) make_turntable(scene, clip_options, options.turntable, still);
    const RunFolder folder = place_of_render(options, cached, scene, clip_options);
    clip_options.keep_longer = options.output.empty();
    if (turns && (options.cluster.submit || options.collect || options.point >= 0))
        throw UsageError("--turntable is drawn on one machine: it does not go with --slurm");
    if (options.cluster.submit) return send_ranges(options, scene, cached, folder, clip_options);
    const bool range_only = options.point >= 0;
    if (range_only) narrow_to_range(options, clip_options);
    if (options.collect) gather_ranges(options, scene, folder, clip_options);
    check_clip(scene, folder, clip_options);
    std::filesystem::create_directories(folder.frames());
    // Tasks with other ranges write there at the same time: they own no more than their pictures.
    std::optional<FolderLock> lock;
    if (!range_only) {
        lock.emplace(folder.root);
        remove_partial_files(folder.frames());
    }

    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const int frames = cached_frames(cached, as_run, hash, model.size(), model.springs.size());
    if (frames <= (turns ? 0 : clip_options.first)) {
        throw FolderError(fmt::format("'{}' holds {} usable frames, and the first asked for is {}: {}",
                                      cached.root.string(), frames, clip_options.first,
                                      why_unusable(cached, frames, hash)));
    }
    // Until here a signal ends the program: there is nothing to finish.
    const InterruptWatch watch;
    if (turns)
        return draw_turntable(options, scene, model, placement, {cached, folder}, clip_options,
                              std::min(still, frames - 1), hash);
    const int last = std::min(frames - 1, clip_options.last);
    Progress progress(scene.name, last - clip_options.first + 1, options.quiet);
    int next = 0;
    PageRecorder recorder(model, folder.root);
    SpooledList<StepReport> spooled(folder.root);
    const auto read = [&] {
        FrameRecord record = read_frame(cached, next++, hash, model.size(), model.springs.size());
        recorder.see(record);
        spooled.append(record.reports);
        return record;
    };
    const FrameSource source = [&]() -> std::optional<FrameRecord> {
        if (next > last || InterruptWatch::requested()) return std::nullopt;
        return read();
    };
    Previews previews = previews_of(scene, clip_options, folder.root);
    clip_options.picture = take_previews(previews);
    const ClipReport report = make_clip(scene, model, placement, folder, clip_options, source,
                                        [&](int frame) { progress.show(frame - clip_options.first + 1, 0); });
    progress.finish();
    if (range_only) {
        if (last < clip_options.last)
            throw FolderError(fmt::format("'{}' holds no usable frame {}", cached.root.string(), last + 1));
        return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
    }
    const auto write_page = [&](const nlohmann::ordered_json& run) {
        std::vector<StepReport> reports = spooled.read_all();
        if (std::filesystem::exists(cached.stats()))
            take_times(read_whole_text(cached.stats(), largest_stats), reports);
        write_report_page(scene, model, folder, recorder, reports, previews, page_facts(run));
    };
    nlohmann::ordered_json run = left;
    run["renderer"] = {{"name", report.renderer}, {"why", report.renderer_summary}};
    run["encoder"] = report.encoders;
    if (InterruptWatch::requested()) {
        if (!options.quiet)
            fmt::print("interrupted: {} of {} frames drawn{}{}\n", report.frames,
                       last - clip_options.first + 1, report.kept.empty() ? "" : "; ", report.kept);
        run["status"] = "interrupted";
        // The page of a clip that stays is as true as before.
        if (report.kept.empty()) write_page(run);
        return InterruptWatch::exit_code();
    }
    // The page shows the whole run, also where only some frames were drawn anew.
    while (next < frames) read();
    write_page(run);
    print_files(options, folder, clip_options, report);
    if (!options.quiet)
        fmt::print("{}  {}\n", report.kept.empty() ? "" : "  " + report.kept + "\n",
                   folder.report().string());
    // A state that is damaged hides the frames from it on: named when all before it are drawn.
    if (last < clip_options.last && std::filesystem::exists(cached.record(frames)))
        read_frame(cached, frames, hash, model.size(), model.springs.size());
    return exit_done;
}

}  // namespace unravel::tool
