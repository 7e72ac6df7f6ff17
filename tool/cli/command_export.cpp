// unravel export RUN_DIR: the cached geometry of a run, for other programs.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file_errors.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/picture_options.hpp"
#include "tool/export/formats.hpp"
#include "tool/folder/cached_run.hpp"
#include "tool/run/run_json.hpp"

namespace unravel::tool {

namespace {

struct ExportOptions {
    std::filesystem::path run, folder;
    std::string format, frames;
    bool cameras = false;  ///< into glb
    OutputOptions output;
};

const ExportFormat& format_of(const std::string& word) {
    const std::span<const ExportFormat> formats = export_formats();
    return *std::ranges::find(formats, word, &ExportFormat::word);  // the command line takes no others
}

std::vector<std::string> format_words() {
    std::vector<std::string> words;
    for (const ExportFormat& format : export_formats()) words.emplace_back(format.word);
    return words;
}

int export_run(const ExportOptions& options) {
    const InterruptWatch watch;
    const CachedRun run = open_cached_run(options.run);
    const FrameRange range = frames_of(options.frames, run.scene);
    const int frames = run.usable_frames();
    run.require(range.first, frames);
    ExportSource source{run.model,          {}, range.first, std::min(range.last, frames - 1),
                        run.scene.clip.fps, {}, {}};
    for (const ClothPatch& patch : run.model.cloths) source.surfaces.push_back(surface_of(patch));
    add_surroundings(source, run.scene, options.cameras);
    source.read = [&](int frame) { return run.read(frame); };
    const std::string own_name = std::filesystem::weakly_canonical(options.run).filename().string();
    const std::string name = own_name.empty() ? "unravel" : own_name;
    Progress progress(name, source.frames(), !options.output.talks());
    source.done = [&](int frame) {
        progress.show(frame - source.first + 1, 0);
        return !InterruptWatch::requested();
    };
    const std::filesystem::path folder =
        options.folder.empty() ? options.run / "export" / options.format : options.folder;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw OutputError(folder, error.value());
    const Written written = format_of(options.format).write(source, folder, name);
    progress.finish();
    if (options.output.json) {
        nlohmann::ordered_json json{{"format", options.format},     {"units", "metres"},
                                    {"axes", "right-handed, y up"}, {"fps", rate_json(source.fps)},
                                    {"first", source.first},        {"last", source.last}};
        for (const auto& file : written) json["files"].push_back(file.string());
        fmt::print("{}\n", json.dump(2));
    } else if (!options.output.quiet && !written.empty()) {
        fmt::print("  {}{}\n  metres, right-handed, y up; frames {}-{} at {} per second\n",
                   written.front().string(),
                   written.size() > 1 ? fmt::format(" … {}", written.back().filename().string()) : "",
                   source.first, source.last, rate_text(source.fps));
    }
    return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
}

}  // namespace

void add_export(CommandLine& line) {
    const auto [command, o] =
        line.add("export", "a cached run's geometry for other programs, frame by frame", export_run);
    command.add_option("RUN_DIR", o.run, "folder of the run")->required();
    command.add_option("--format", o.format, "obj, ply, pc2, mdd or glb (docs/geometry.md)")
        ->check(CLI::IsMember(format_words()))
        ->required();
    command.add_option("-o", o.folder, "folder for the files (default: RUN_DIR/export/FORMAT)");
    add_frames(command, o.frames);
    command.add_flag("--cameras", o.cameras, "with the scene's cameras, into glb");
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
