// unravel export RUN_DIR: the cached geometry of a run, for other programs.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/scene_file/load.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/options.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/render_options.hpp"
#include "tool/export/export.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

Written export_as(const std::string& format, const ExportSource& source, const std::filesystem::path& folder,
                  const std::string& name) {
    if (format == "obj") return export_obj(source, folder);
    if (format == "pc2") return export_point_cache(source, folder, false);
    if (format == "mdd") return export_point_cache(source, folder, true);
    if (format == "glb") return export_glb(source, folder, name);
    ComponentColors colors;
    const auto edges = drawn_edges(source.model);
    return export_ply(source, folder,
                      [&](const FrameRecord& record) { return colors.assign(record.component, edges); });
}

}  // namespace

int command_export(const Options& options) {
    const InterruptWatch watch;
    const RunFolder run{options.scene};
    if (!std::filesystem::exists(run.scene())) {
        throw FolderError(fmt::format(
            "'{}' holds no run: it has no scene.toml; `unravel run SCENE` makes one", run.root.string()));
    }
    Scene scene = load_scene(run.scene());
    const ClipOptions clip = clip_options_of(options, scene);  // of them --frames
    const std::uint64_t hash = scene_hash(scene);
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const int frames = cached_frames(run, scene, hash, model.size(), model.springs.size());
    if (frames <= clip.first)
        throw FolderError(fmt::format("'{}' holds {} usable frames, and the first asked for is {}: {}",
                                      run.root.string(), frames, clip.first,
                                      why_unusable(run, frames, hash)));
    ExportSource source{model, {}, clip.first, std::min(clip.last, frames - 1), scene.clip.fps, {}, {}};
    for (const ClothPatch& patch : model.cloths) source.surfaces.push_back(surface_of(patch));
    source.read = [&](int frame) { return read_frame(run, frame, hash, model.size(), model.springs.size()); };
    const std::string own_name = std::filesystem::weakly_canonical(run.root).filename().string();
    const std::string name = own_name.empty() ? "unravel" : own_name;
    Progress progress(name, source.frames(), options.quiet || options.json);
    source.done = [&](int frame) {
        progress.show(frame - source.first + 1, 0);
        return !InterruptWatch::requested();
    };
    const std::filesystem::path folder =
        options.output.empty() ? run.root / "export" / options.format : options.output;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw OutputError(folder, error.value());
    const Written written = export_as(options.format, source, folder, name);
    progress.finish();
    if (options.json) {
        nlohmann::ordered_json json{{"format", options.format},     {"units", "metres"},
                                    {"axes", "right-handed, y up"}, {"fps", rate_json(source.fps)},
                                    {"first", source.first},        {"last", source.last}};
        for (const auto& file : written) json["files"].push_back(file.string());
        fmt::print("{}\n", json.dump(2));
    } else if (!options.quiet && !written.empty()) {
        fmt::print("  {}{}\n  metres, right-handed, y up; frames {}-{} at {} per second\n",
                   written.front().string(),
                   written.size() > 1 ? fmt::format(" … {}", written.back().filename().string()) : "",
                   source.first, source.last, rate_text(source.fps));
    }
    return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
}

}  // namespace unravel::tool
