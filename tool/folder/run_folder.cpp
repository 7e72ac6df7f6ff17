#include "tool/folder/run_folder.hpp"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "base/file_errors.hpp"
#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/limits.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/scene_file/look_pictures.hpp"
#include "tool/base/version.hpp"
#include "tool/folder/clip_view.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_scene = 16 << 20;
constexpr std::size_t largest_run_json = std::size_t{64} << 20;
constexpr std::size_t largest_record = std::size_t{4} << 30;

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

// The version of the tool that a folder's run was made with, as its run.json says.
std::string version_of_run(const RunFolder& folder) {
    const std::string unknown = "of a version that is not known";
    const nlohmann::ordered_json run = read_run_json(folder);
    const bool told = run.contains("version") && run["version"].is_string();
    return told ? run["version"].get<std::string>() : unknown;
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

std::vector<std::string> named_files(const Scene& scene) {
    std::vector<std::string> names;
    for (const NamedPicture& picture : look_pictures(scene.look)) names.push_back(picture.file);
    for (const Cloth& cloth : scene.cloths) names.push_back(cloth.mesh.file);
    for (const Solid& solid : scene.solids) {
        names.push_back(solid.mesh.file);
        if (!solid.geometry) continue;
        names.insert(names.end(), solid.geometry->sample_files.begin(), solid.geometry->sample_files.end());
    }
    return names;
}

}  // namespace

void copy_named_files(const fs::path& folder, const Scene& scene, const fs::path& home) {
    for (const std::string& file : named_files(scene)) {
        const fs::path name = fs::path(file).lexically_normal();
        if (name.empty() || *name.begin() == "..") continue;
        const fs::path from = home / name, to = folder / name;
        std::error_code error;
        if (fs::equivalent(from, to, error)) continue;
        create_folder(to.parent_path());
        // Whole or not at all: a run that is killed here must find its meshes again.
        write_whole_file(to, read_whole_file(from, max_mesh_bytes));
    }
}

namespace {

// The hash alone would tell that a mesh has changed, but not to a person.
void refuse_changed_meshes(const RunFolder& folder, const Scene& before, const Scene& now) {
    const auto compare = [&](const auto& a, const auto& b) {
        for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
            if (a[k].mesh.file != b[k].mesh.file || a[k].mesh.hash == b[k].mesh.hash) continue;
            throw FolderError(fmt::format(
                "'{}' was made from another scene (the mesh \"{}\" of {} has changed since; the run's own "
                "copy "
                "is in its folder): --force starts anew in its place, -o DIR puts this one elsewhere",
                folder.root.string(), b[k].mesh.file, b[k].name));
        }
    };
    compare(before.cloths, now.cloths);
    compare(before.solids, now.solids);
}

}  // namespace

Existing usual_existing(const RunFolder& folder, const Scene& scene) {
    if (!fs::exists(folder.scene())) return fs::exists(folder.cache()) ? Existing::refuse : Existing::resume;
    try {
        const std::string before = read_whole_text(folder.scene(), largest_scene);
        const Scene earlier = parse_scene(before, folder.scene().string(), folder.root);
        const nlohmann::ordered_json run = read_run_json(folder);
        const bool complete = run.contains("status") && run["status"] == "complete";
        // A still is complete without the frames behind it.
        const bool whole = run.contains("frames") && run["frames"] == earlier.clip.frames();
        if (complete && whole) return Existing::refuse;
        return simulated_part(earlier) == simulated_part(scene) ? Existing::resume : Existing::replace;
    } catch (const SceneError&) {
        return Existing::refuse;  // of another version, which may be worth keeping
    }
}

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
        for (const fs::path& path : {folder.cache(), folder.frames(), folder.next()})
            fs::remove_all(path, error);
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
        refuse_changed_meshes(folder, earlier, scene);
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
    if (!textures.empty()) copy_named_files(folder.root, scene, textures);
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

nlohmann::ordered_json read_run_json(const RunFolder& folder) {
    if (!fs::exists(folder.run_json())) return {};
    auto run =
        nlohmann::ordered_json::parse(read_whole_text(folder.run_json(), largest_run_json), nullptr, false);
    if (!run.is_object()) return {};
    return run;
}

std::string why_unusable(const RunFolder& folder, int frame, std::uint64_t scene_hash) {
    if (!fs::exists(folder.record(frame)))
        return fmt::format(
            "there is no frame {}: the run ended before it, or was stopped (`unravel run SCENE -o {} "
            "--resume` "
            "goes on)",
            frame, folder.root.string());
    const std::vector<std::uint8_t> bytes = read_whole_file(folder.record(frame), largest_record);
    const std::string again =
        fmt::format("`unravel run SCENE -o {} --resume` makes it again", folder.root.string());
    // Records begin with their format's version, then the hash of their scene.
    const std::size_t name = record_magic.size() - 1;
    const bool record = bytes.size() >= record_magic.size() + sizeof scene_hash &&
                        std::memcmp(bytes.data(), record_magic.data(), name) == 0;
    if (!record) return fmt::format("frame {} is damaged: {}", frame, again);
    const int format = bytes[name], own_format = record_magic.back();
    if (format != own_format)
        return fmt::format(
            "its frames are in format {}, by unravel {}, and this is unravel {}, of format {}: "
            "draw it with the version that made it, or simulate it again with "
            "`unravel run SCENE --force`",
            format, version_of_run(folder), version(), own_format);
    std::uint64_t made_from = 0;
    std::memcpy(&made_from, bytes.data() + record_magic.size(), sizeof made_from);
    if (made_from == scene_hash) return fmt::format("frame {} is damaged: {}", frame, again);
    if (made_from == tool::scene_hash(load_scene(folder.scene())))
        return "what --set changes is not only how the scene looks: that needs a run of its own, "
               "`unravel run SCENE --set ... -o DIR`";
    return fmt::format(
        "its frames, by unravel {}, are of another scene than its scene.toml is to this unravel {}: "
        "scene.toml was changed since, or that version understood it differently; draw it with the "
        "version that made it, or simulate it again with `unravel run SCENE --force`",
        version_of_run(folder), version());
}

FrameRecord read_frame(const RunFolder& folder, int frame, std::uint64_t scene_hash, std::size_t particles,
                       std::size_t springs) {
    try {
        return read_record(folder.record(frame), scene_hash, particles, springs);
    } catch (const InputError&) {
        throw InputError(folder.record(frame), why_unusable(folder, frame, scene_hash));
    }
}

}  // namespace unravel::tool
