#include "tool/folder/cached_run.hpp"

#include <fmt/format.h>

#include "base/file_errors.hpp"

#include "sim/scene_file/load.hpp"

namespace unravel::tool {

FrameRecord CachedRun::read(int frame) const {
    try {
        return read_record(folder.record(frame), hash, model.size(), model.springs.size());
    } catch (const InputError&) {
        throw InputError(folder.record(frame), why_unusable(folder, frame, hash));
    }
}

int CachedRun::usable_frames() const {
    return cached_frames(folder, scene, hash, model.size(), model.springs.size());
}

void CachedRun::require(int frame, int usable) const {
    if (frame >= 0 && frame < usable) return;
    throw FolderError(fmt::format("'{}' holds {} usable frames, and frame {} is asked for: {}",
                                  folder.root.string(), usable, frame, why_unusable(folder, usable, hash)));
}

CachedRun open_cached_run(const std::filesystem::path& folder, const std::vector<std::string>& overrides) {
    CachedRun run;
    run.folder = {folder};
    if (!std::filesystem::exists(run.folder.scene())) {
        throw FolderError(fmt::format(
            "'{}' holds no run: it has no scene.toml; `unravel run SCENE` makes one", folder.string()));
    }
    run.scene = load_scene(run.folder.scene(), overrides);
    run.hash = scene_hash(run.scene);
    run.model = build_model(run.scene, run.placement);
    return run;
}

}  // namespace unravel::tool
