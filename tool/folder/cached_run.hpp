#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

/// A run that lies in its folder, opened to be looked at.
struct CachedRun {
    RunFolder folder;
    Scene scene;             ///< as run, but for what was to be another value of its look
    std::uint64_t hash = 0;  ///< of what was simulated
    Placement placement;
    ClothModel model;

    /// Throws InputError with why_unusable() where it can't be read.
    FrameRecord read(int frame) const;
    /// Frames 0 … k−1 that can be read; reads them all.
    int usable_frames() const;
    /// Throws FolderError that says why where `frame` is not among the `usable` first ones.
    void require(int frame, int usable) const;
};

/// Throws FolderError where the folder holds no run, SceneError where its scene with `overrides` is none.
CachedRun open_cached_run(const std::filesystem::path& folder,
                          const std::vector<std::string>& overrides = {});

}  // namespace unravel::tool
