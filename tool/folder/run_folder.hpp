#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Where a run's files are. Every one of them appears whole or not at all.
struct RunFolder {
    std::filesystem::path root;

    std::filesystem::path scene() const { return root / "scene.toml"; }
    std::filesystem::path run_json() const { return root / "run.json"; }
    std::filesystem::path stats() const { return root / "stats.csv"; }
    std::filesystem::path report() const { return root / "report.html"; }
    std::filesystem::path cache() const { return root / "cache"; }
    std::filesystem::path frames() const { return root / "frames"; }
    std::filesystem::path failure() const { return root / "failure"; }
    /// Where a clip is drawn that is to replace the one that is there, until it is whole.
    std::filesystem::path next() const { return root / "next"; }
    std::filesystem::path record(int frame) const;
    /// `view`: its name, see ClipView.
    std::filesystem::path picture(const std::string& view, int frame) const;
    std::filesystem::path video(const std::string& view, const std::string& ending) const;
};

/// A run's run.json; null where there is none, or where what is there is no JSON object.
nlohmann::ordered_json read_run_json(const RunFolder& folder);

/// No stats.csv is longer; one that is would be no such file.
inline constexpr std::size_t largest_stats = std::size_t{1} << 30;

/// What was asked for cannot be done with the folder as it is; what() says how to go on. Exit code 2.
class FolderError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

enum class Existing { refuse, resume, replace };

/// What to do with what is in a folder where nothing was said: a run that is complete, with all its frames,
/// is not touched; one that is not goes on where it is of the same scene, and makes room where it is not.
Existing usual_existing(const RunFolder& folder, const Scene& scene);

/// Makes the folder ready for a run of this scene: creates it, removes what a killed run left half-written,
/// and where a run is there already refuses, goes on from it, or removes it. Going on with a changed scene is
/// refused with what changed. Pictures that the scene names relative to `textures` are copied along. Returns
/// the scene's hash, which ties cache files to it. Throws FolderError, OutputError.
std::uint64_t open_run(const RunFolder& folder, const Scene& scene, Existing existing,
                       const std::filesystem::path& textures = {});

/// A folder's own copies of the pictures and meshes that the scene names relative to `home`, under the same
/// names: the folder can be moved, drawn again and gone on with. Throws OutputError.
void copy_named_files(const std::filesystem::path& folder, const Scene& scene,
                      const std::filesystem::path& home);

/// Frames 0 … k−1 that the cache holds whole and undamaged; the first that is missing ends the list.
int cached_frames(const RunFolder& folder, const Scene& scene, std::uint64_t scene_hash,
                  std::size_t particles, std::size_t springs);

/// Why a frame of the cache cannot be used, and what to do: nobody wrote it, another version of the tool did,
/// it is damaged, or the scene asked for differs from the run's in more than its picture. For a frame that
/// cached_frames() did not count.
std::string why_unusable(const RunFolder& folder, int frame, std::uint64_t scene_hash);

/// A frame of the cache. Throws InputError with why_unusable() where it can't be read.
FrameRecord read_frame(const RunFolder& folder, int frame, std::uint64_t scene_hash, std::size_t particles,
                       std::size_t springs);

/// Hash of the scene as run. Only what changes the simulation counts.
std::uint64_t scene_hash(const Scene& scene);

}  // namespace unravel::tool
