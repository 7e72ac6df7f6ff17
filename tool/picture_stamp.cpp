#include "tool/picture_stamp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "sim/frame_record.hpp"
#include "sim/scene/load.hpp"
#include "tool/version.hpp"

namespace unravel {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_stamp = 1 << 20;
constexpr std::size_t largest_texture = std::size_t{1} << 30;

fs::path stamp_file(const RunFolder& folder, const std::string& view) {
    return folder.frames() / fmt::format("{}_drawn_with.json", view);
}

// The file under a texture's name may be replaced by another picture.
std::string texture_hash(const std::string& texture) {
    try {
        const std::vector<std::uint8_t> bytes = read_whole_file(texture, largest_texture);
        return fmt::format("{:016x}", hash_bytes(bytes.data(), bytes.size()));
    } catch (const InputError&) {
        return "missing";
    }
}

bool is_picture(const std::string& name, const std::string& view) {
    const std::string start = view + "_";
    if (!name.starts_with(start) || !name.ends_with(".png")) return false;
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(start.size()), name.end() - 4,
                       [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::string picture_stamp(const Scene& scene, const ClipOptions& options, const std::string& renderer) {
    Scene drawn;
    drawn.cameras = scene.cameras;
    drawn.look = scene.look;
    const std::string look = scene_to_toml(drawn);
    nlohmann::ordered_json json{{"version", version()},
                                {"renderer", renderer},
                                {"size", scene.clip.size},
                                {"samples", options.samples},
                                {"supersample", options.supersample},
                                {"look", fmt::format("{:016x}", hash_bytes(look.data(), look.size()))},
                                // An orbit takes as long as the clip.
                                {"duration", scene.clip.duration}};
    const bool turns = std::any_of(scene.cameras.begin(), scene.cameras.end(),
                                   [](const Camera& camera) { return camera.orbit != 0; });
    if (!turns) json.erase("duration");
    for (const ClothLook& cloth : scene.look.cloth) {
        if (!cloth.texture.empty()) json["textures"].push_back(texture_hash(cloth.texture));
    }
    return json.dump(2) + "\n";
}

bool claim_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp,
                    bool whole_clip) {
    const fs::path file = stamp_file(folder, view);
    if (fs::exists(file)) {
        const std::vector<std::uint8_t> before = read_whole_file(file, largest_stamp);
        if (std::string(before.begin(), before.end()) == stamp) return true;
        // First of all: were the program to end here, nothing would vouch for the old pictures.
        fs::remove(file);
    }
    if (!whole_clip) return false;
    for (const auto& entry : fs::directory_iterator(folder.frames())) {
        if (is_picture(entry.path().filename().string(), view)) fs::remove(entry.path());
    }
    write_whole_file(file, stamp);
    return false;
}

}  // namespace unravel
