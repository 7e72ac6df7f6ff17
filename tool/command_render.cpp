// unravel render RUN_DIR: pictures and videos from a cached run, without simulating again.

#include <fmt/format.h>

#include "base/whole_file.hpp"
#include "sim/scene/load.hpp"
#include "sim/simulate.hpp"
#include "tool/clip.hpp"
#include "tool/folder_lock.hpp"
#include "tool/interrupt.hpp"
#include "tool/options.hpp"
#include "tool/progress.hpp"
#include "tool/render_options.hpp"

namespace unravel {

int command_render(const Options& options) {
    const InterruptWatch watch;
    const RunFolder cached{options.scene};
    if (!std::filesystem::exists(cached.scene())) {
        throw FolderError(fmt::format(
            "'{}' holds no run: it has no scene.toml; `unravel run SCENE` makes one", cached.root.string()));
    }
    Scene scene = load_scene(cached.scene(), options.overrides);
    const std::uint64_t hash = scene_hash(scene);
    const ClipOptions clip_options = clip_options_of(options, scene);
    const RunFolder folder{options.output.empty() ? cached.root : options.output};
    check_clip(scene, folder, clip_options);
    const FolderLock lock(folder.root);
    std::filesystem::create_directories(folder.frames());
    remove_partial_files(folder.frames());

    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const int frames = cached_frames(cached, scene, hash, model.size(), model.springs.size());
    if (frames <= clip_options.first) {
        throw FolderError(
            fmt::format("'{}' holds {} usable frames of this scene, and the first asked for is {}: was it "
                        "made from another scene, or stopped early?",
                        cached.root.string(), frames, clip_options.first));
    }
    const int last = std::min(frames - 1, clip_options.last);
    Progress progress(scene.name, last - clip_options.first + 1, options.quiet);
    int next = 0;
    const FrameSource source = [&]() -> std::optional<FrameRecord> {
        if (next > last || InterruptWatch::requested()) return std::nullopt;
        return read_record(cached.record(next++), hash, model.size(), model.springs.size());
    };
    const ClipReport report = make_clip(scene, model, placement, folder, clip_options, source,
                                        [&](int frame) { progress.show(frame - clip_options.first + 1, 0); });
    progress.finish();
    if (!options.quiet) {
        for (const std::string& video : report.videos) fmt::print("  {}\n", (folder.root / video).string());
    }
    return InterruptWatch::requested() ? exit_interrupted : exit_done;
}

}  // namespace unravel
