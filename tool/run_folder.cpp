#include "tool/run_folder.hpp"

#include <fmt/format.h>

#include <sstream>
#include <vector>

#include "base/file_errors.hpp"
#include "base/whole_file.hpp"
#include "sim/scene/load.hpp"
#include "tool/clip_view.hpp"

namespace unravel {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_scene = 16 << 20;

// The scene without what only the picture depends on, and without how long it goes on: a clip may be made
// longer.
std::string simulated_part(Scene scene) {
    scene.clip.size = Clip{}.size;
    scene.clip.duration = Clip{}.duration;
    scene.cameras = {Camera{}};
    scene.look = Look{};
    return scene_to_toml(scene);
}

std::string first_difference(const std::string& before, const std::string& now) {
    std::istringstream a(before), b(now);
    for (std::string x, y; std::getline(a, x), std::getline(b, y), a || b; x.clear(), y.clear()) {
        if (x != y)
            return fmt::format("it was '{}' and is '{}' now", x.empty() ? "nothing" : x,
                               y.empty() ? "nothing" : y);
    }
    return "it differs";
}

void create_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw OutputError(folder, error.value());
}

}  // namespace

fs::path RunFolder::record(int frame) const {
    return cache() / fmt::format("frame_{:04}.state", frame);
}

fs::path RunFolder::picture(const std::string& view, int frame) const {
    return frames() / fmt::format("{}_{:04}.png", view, frame);
}

fs::path RunFolder::video(const std::string& view, const std::string& ending) const {
    return root / (view + ending);
}

std::uint64_t scene_hash(const Scene& scene) {
    const std::string text = simulated_part(scene);
    return hash_bytes(text.data(), text.size());
}

namespace {

// The run's own copies of the scene's pictures, under the same names: the folder can be moved and drawn
// again.
void copy_textures(const RunFolder& folder, const Scene& scene, const fs::path& textures) {
    for (const ClothLook& look : scene.look.cloth) {
        const fs::path name = fs::path(look.texture).lexically_normal();
        if (name.empty() || *name.begin() == "..") continue;
        const fs::path from = textures / name, to = folder.root / name;
        std::error_code error;
        if (fs::equivalent(from, to, error)) continue;
        create_folder(to.parent_path());
        if (!fs::copy_file(from, to, fs::copy_options::overwrite_existing, error))
            throw OutputError(to, fmt::format("copying {} failed: {}", from.string(), error.message()));
    }
}

}  // namespace

std::uint64_t open_run(const RunFolder& folder, const Scene& scene, Existing existing,
                       const fs::path& textures) {
    const bool there = fs::exists(folder.scene()) || fs::exists(folder.cache());
    if (there && existing == Existing::refuse) {
        throw FolderError(
            fmt::format("'{}' holds a run already: --resume goes on from where it stopped, --force starts "
                        "anew in its place, -o DIR puts this one elsewhere",
                        folder.root.string()));
    }
    if (there && existing == Existing::replace) {
        // Only what a run writes is removed; anything else in the folder is the user's.
        std::error_code error;
        // The scene goes last: what is half removed when the program ends still counts as a run.
        for (const fs::path& path : {folder.cache(), folder.frames()}) fs::remove_all(path, error);
        for (const char* ending : {".mp4", ".webm", ".mkv", ".gif"}) {
            for (std::size_t camera = 0; camera < scene.cameras.size(); ++camera) {
                for (const Layout layout : all_layouts)
                    fs::remove(folder.video(make_view(scene, layout, camera).name, ending), error);
            }
        }
        for (const char* name : {"run.json", "stats.csv", "report.html", "scene.toml"})
            fs::remove(folder.root / name, error);
    }
    for (const fs::path& path : {folder.root, folder.cache(), folder.frames()}) {
        create_folder(path);
        remove_partial_files(path);
    }
    if (there && existing == Existing::resume && fs::exists(folder.scene())) {
        const std::string before = read_whole_text(folder.scene(), largest_scene);
        const Scene earlier = parse_scene(before, folder.scene().string(), folder.root);
        if (simulated_part(earlier) != simulated_part(scene)) {
            throw FolderError(fmt::format(
                "'{}' was made from another scene ({}): --force starts anew in its place, -o DIR "
                "puts this one elsewhere",
                folder.root.string(), first_difference(simulated_part(earlier), simulated_part(scene))));
        }
    }
    // What stopped an earlier run is no news of this one.
    std::error_code error;
    fs::remove_all(folder.failure(), error);
    if (!textures.empty()) copy_textures(folder, scene, textures);
    write_whole_file(folder.scene(), scene_to_toml(scene));
    return scene_hash(scene);
}

int cached_frames(const RunFolder& folder, const Scene& scene, std::uint64_t hash, std::size_t particles,
                  std::size_t springs) {
    int frames = 0;
    while (frames < scene.clip.frames() && fs::exists(folder.record(frames))) {
        try {
            read_record(folder.record(frames), hash, particles, springs);
        } catch (const InputError&) {
            break;  // simulated again from the frame before
        }
        ++frames;
    }
    return frames;
}

}  // namespace unravel
