// unravel render RUN_DIR: pictures and videos from a cached run, without simulating again.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "sim/run/simulate.hpp"
#include "sim/run/stats.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/frame_ranges.hpp"
#include "tool/cli/picture_options.hpp"
#include "tool/cli/render_place.hpp"
#include "tool/folder/cached_run.hpp"
#include "tool/folder/folder_lock.hpp"
#include "tool/picture/clip.hpp"
#include "tool/picture/turntable.hpp"
#include "tool/picture/vector_still.hpp"
#include "tool/picture/wire_colors.hpp"
#include "tool/report/page.hpp"

namespace unravel::tool {

namespace {

struct RenderOptions {
    std::filesystem::path run, folder;  // the folder for the pictures; empty: the run's
    std::vector<std::string> overrides;
    PictureOptions pictures;
    PieceOptions pieces;
    int parts = 0;                   // ranges of frames that the work is cut into; 0: chosen
    std::vector<std::string> words;  // the command line as it was written
    OutputOptions output;
};

// What the run left about itself; a run that was killed left nothing, and its page says less.
nlohmann::ordered_json earlier_run(const RunFolder& folder) {
    nlohmann::ordered_json run = read_run_json(folder);
    if (run.is_null()) run = {{"status", "unfinished"}};
    return run;
}

void print_files(const OutputOptions& output, const RunFolder& folder, const ClipOptions& clip_options,
                 const ClipReport& report) {
    if (output.quiet) return;
    for (const std::string& video : report.videos) fmt::print("  {}\n", (folder.root / video).string());
    if (!report.videos.empty() || !clip_options.keep_pictures) return;
    for (const ClipView& view : clip_options.views)
        fmt::print("  {}\n", folder.picture(view.name, clip_options.first).string());
}

// One turn about a frame that stands still; the run's page stays as it is.
int draw_turntable(const RenderOptions& options, const CachedRun& run, const Scene& scene,
                   const RunFolder& folder, const ClipOptions& clip_options, int frame) {
    const FrameRecord record = run.read(frame);
    Progress progress(scene.name, clip_options.last + 1, options.output.quiet);
    const FrameSource turn = turntable_source(clip_options, record);
    const FrameSource source = [&]() -> std::optional<FrameRecord> {
        return InterruptWatch::requested() ? std::nullopt : turn();
    };
    const ClipReport report = make_clip(scene, run.model, run.placement, folder, clip_options, source,
                                        [&](int done) { progress.show(done + 1, 0); });
    progress.finish();
    print_files(options.output, folder, clip_options, report);
    return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
}

int send(const RenderOptions& options, const Scene& scene, const CachedRun& run, const RunFolder& folder,
         const ClipOptions& clip_options, const std::vector<FrameRange>& ranges) {
    ClusterWork work = range_work(ranges, scene, run.folder, folder, clip_options);
    work.words = options.words;
    if (options.parts == 0) work.more = {"--parts", std::to_string(ranges.size())};
    return do_on_cluster(options.pieces.cluster, options.output, work);
}

// The frames of a clip from a run's cache; what is read on the way goes into the page.
class CachedFrames {
public:
    CachedFrames(const CachedRun& run, const RunFolder& folder)
        : run_(run), recorder_(run.model, folder.root), reports_(folder.root) {}

    int read() const { return next_; }
    FrameRecord next() {
        FrameRecord record = run_.read(next_++);
        recorder_.add(record);
        reports_.append(record.reports);
        return record;
    }
    const PageRecorder& recorder() const { return recorder_; }
    // Of all steps that were read, with the times that the run took for them.
    std::vector<StepReport> reports() const {
        std::vector<StepReport> reports = reports_.read_all();
        if (std::filesystem::exists(run_.folder.stats()))
            take_times(read_whole_text(run_.folder.stats(), largest_stats), reports);
        return reports;
    }

private:
    const CachedRun& run_;
    int next_ = 0;
    PageRecorder recorder_;
    DiskList<StepReport> reports_;
};

// The clip's frames, and a page that shows the whole run. `range_only`: the frames of a task, which shares
// its folder with others and leaves the page to the last of them.
int draw_clip(const RenderOptions& options, const CachedRun& run, const Scene& scene, const RunFolder& folder,
              ClipOptions& clip_options, int frames, bool range_only) {
    const int first = clip_options.first, last = std::min(frames - 1, clip_options.last);
    Progress progress(scene.name, last - first + 1, options.output.quiet);
    CachedFrames cached(run, folder);
    const FrameSource source = [&]() -> std::optional<FrameRecord> {
        if (cached.read() > last || InterruptWatch::requested()) return std::nullopt;
        return cached.next();
    };
    Previews previews = previews_of(scene, clip_options, folder.root);
    clip_options.picture = take_previews(previews);
    const ClipReport report = make_clip(scene, run.model, run.placement, folder, clip_options, source,
                                        [&](int frame) { progress.show(frame - first + 1, 0); });
    progress.finish();
    if (range_only) {
        if (last < clip_options.last)
            throw FolderError(
                fmt::format("'{}' holds no usable frame {}", run.folder.root.string(), last + 1));
        return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
    }
    nlohmann::ordered_json about = earlier_run(run.folder);
    about["renderer"] = {{"name", report.renderer}, {"why", report.renderer_summary}};
    about["encoder"] = report.encoders;
    const auto write_page = [&] {
        write_report_page(scene, run.model, folder, cached.recorder(), cached.reports(), previews,
                          page_facts(about));
    };
    if (InterruptWatch::requested()) {
        if (!options.output.quiet)
            fmt::print("interrupted: {} of {} frames drawn{}{}\n", report.frames, last - first + 1,
                       report.kept.empty() ? "" : "; ", report.kept);
        about["status"] = "interrupted";
        // The page of a clip that stays is as true as before.
        if (report.kept.empty()) write_page();
        return InterruptWatch::exit_code();
    }
    // The page shows the whole run, also where only some frames were drawn anew.
    while (cached.read() < frames) cached.next();
    write_page();
    print_files(options.output, folder, clip_options, report);
    if (!options.output.quiet)
        fmt::print("{}  {}\n", report.kept.empty() ? "" : "  " + report.kept + "\n",
                   folder.report().string());
    // A state that is damaged hides the frames from it on: named when all before it are drawn.
    if (last < clip_options.last && std::filesystem::exists(run.folder.record(frames))) run.read(frames);
    return exit_done;
}

// A scale whose end the scene does not say ends where the whole clip's values do, but for the highest 1%.
void set_scale(const CachedRun& run, int frames, Look& look) {
    if (look.show_max > 0 || (look.show != Show::strain && look.show != Show::velocity)) return;
    ScaleFinder finder;
    for (int frame = 0; frame < frames; ++frame) finder.add(look.show, run.model, run.read(frame).state);
    look.show_max = finder.end();
}

int draw_figure(const RenderOptions& options, const CachedRun& run, const Scene& scene,
                const RunFolder& folder, const ClipOptions& clip_options) {
    const std::filesystem::path file = write_vector_still(
        scene, run.model, run.placement, folder, clip_options, [&](int frame) { return run.read(frame); });
    if (!options.output.quiet) fmt::print("  {}\n", file.string());
    return exit_done;
}

int render(const RenderOptions& options) {
    const CachedRun run = open_cached_run(options.run, options.overrides);
    Scene scene = run.scene;
    // The folder's scene.toml has lost the name that the scene came by.
    scene.name =
        earlier_run(run.folder).value("scene", (run.folder.root / "").parent_path().filename().string());
    ClipOptions clip_options = clip_options_of(options.pictures, scene);
    clip_options.textures = run.folder.root;
    const bool turns = options.pictures.turntable > 0;
    const int still = options.pictures.still >= 0 ? options.pictures.still : scene.clip.frames() - 1;
    if (turns) make_turntable(scene, clip_options, options.pictures.turntable, still);
    const RunFolder folder = options.folder.empty() ? place_of_render(options.pictures, options.overrides,
                                                                      run.folder, scene, clip_options)
                                                    : RunFolder{options.folder};
    clip_options.keep_longer = options.folder.empty();
    const PieceOptions& pieces = options.pieces;
    if (turns && !pieces.whole())
        throw UsageError("--turntable is drawn on one machine: it does not go with --slurm");
    const int frames = run.usable_frames();
    set_scale(run, frames, scene.look);
    const std::vector<FrameRange> ranges = cut_frames(clip_options.first, clip_options.last, options.parts);
    if (pieces.cluster.submit) return send(options, scene, run, folder, clip_options, ranges);
    const bool range_only = pieces.point >= 0;
    if (range_only) {
        if (static_cast<std::size_t>(pieces.point) >= ranges.size())
            throw UsageError(
                fmt::format("--point {}: the ranges end at {}", pieces.point, ranges.size() - 1));
        narrow_to_range(ranges[static_cast<std::size_t>(pieces.point)], clip_options);
    }
    if (pieces.collect) gather_ranges(ranges, scene, folder, clip_options);
    if (clip_options.format.empty()) check_clip(scene, folder, clip_options);
    std::filesystem::create_directories(folder.frames());
    // Tasks with other ranges write there at the same time: they own no more than their pictures.
    std::optional<FolderLock> lock;
    if (!range_only) {
        lock.emplace(folder.root);
        remove_partial_files(folder.frames());
    }
    run.require(turns ? 0 : clip_options.first, frames);
    if (!clip_options.format.empty()) return draw_figure(options, run, scene, folder, clip_options);
    // Until here a signal ends the program: there is nothing to finish.
    const InterruptWatch watch;
    if (turns) return draw_turntable(options, run, scene, folder, clip_options, std::min(still, frames - 1));
    return draw_clip(options, run, scene, folder, clip_options, frames, range_only);
}

}  // namespace

void add_render(CommandLine& line) {
    const auto [command, o] = line.add("render", "pictures and videos from a cached run", render);
    o.words = line.words();
    command.add_option("RUN_DIR", o.run, "folder of the run")->required();
    command.add_option(
        "-o", o.folder,
        "folder for the pictures (default: the run's own; of a part or another look, in its renders/)");
    add_overrides(command, o.overrides, "key=value of [camera], [look] or clip.size");
    add_picture_options(command, o.pictures);
    add_piece_options(command, o.pieces);
    command
        .add_option("--format", o.pictures.format,
                    "of --still: png, or its component view as a figure for a page, svg or pdf")
        ->check(CLI::IsMember({"png", "svg", "pdf"}))
        ->capture_default_str();
    command.add_option("--parts", o.parts, "ranges that a cluster draws the frames in (default: chosen)")
        ->check(CLI::Range(1, 1000));
    command.add_option("--still", o.pictures.still, "this frame alone, without a video")
        ->check(CLI::NonNegativeNumber);
    command
        .add_option("--turntable", o.pictures.turntable,
                    "seconds of one turn about a frame that stands still: --still, or the last")
        ->check(CLI::Range(0.1, 600.0));
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
