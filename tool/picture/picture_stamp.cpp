#include "tool/picture/picture_stamp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "base/file_errors.hpp"
#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/scene_file/look_pictures.hpp"
#include "tool/base/version.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_stamp = 1 << 20;
constexpr std::size_t largest_texture = std::size_t{1} << 30;

fs::path stamp_file(const RunFolder& folder, const std::string& view) {
    return folder.frames() / fmt::format("{}_drawn_with.json", view);
}

fs::path range_file(const RunFolder& folder, const std::string& view, const FrameRange& range) {
    return folder.frames() / fmt::format("{}_{:04}-{:04}_drawn_with.json", view, range.first, range.last);
}

bool is_range_file(const std::string& name, const std::string& view) {
    // Names differ in their range alone: NAME_0000-0000_drawn_with.json
    if (!name.starts_with(view + "_") || !name.ends_with("_drawn_with.json")) return false;
    const std::size_t start = view.size() + 1, end = name.rfind("_drawn_with");
    if (end <= start) return false;
    const std::string range = name.substr(start, end - start);
    return range.find('-') != range.npos && range.find_first_not_of("0123456789-") == range.npos;
}

void remove_range_files(const RunFolder& folder, const std::string& view,
                        const std::function<bool(const fs::path&)>& stays = {}) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder.frames())) {
        if (is_range_file(entry.path().filename().string(), view)) files.push_back(entry.path());
    }
    for (const fs::path& file : files) {
        if (!stays || !stays(file)) fs::remove(file);
    }
}

std::string text_if_there(const fs::path& file) {
    return fs::exists(file) ? read_whole_text(file, largest_stamp) : std::string();
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

// The frame that a file is the picture of; −1: it is none of this view's.
int frame_of_picture(const std::string& name, const std::string& view) {
    const std::string start = view + "_";
    if (!name.starts_with(start) || !name.ends_with(".png")) return -1;
    int frame = -1;
    const char *first = name.data() + start.size(), *last = name.data() + name.size() - 4;
    const auto [end, error] = std::from_chars(first, last, frame);
    return error == std::errc() && end == last && *first != '-' ? frame : -1;
}

// (frame, file) of a view.
std::vector<std::pair<int, fs::path>> pictures_of(const RunFolder& folder, const std::string& view) {
    std::vector<std::pair<int, fs::path>> pictures;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder.frames(), error)) {
        const int frame = frame_of_picture(entry.path().filename().string(), view);
        if (frame >= 0) pictures.emplace_back(frame, entry.path());
    }
    return pictures;
}

void move_file(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) throw OutputError(to, error.value());
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
                                {"quality", static_cast<int>(options.quality)},
                                {"look", fmt::format("{:016x}", hash_bytes(look.data(), look.size()))},
                                // An orbit takes as long as the clip.
                                {"duration", scene.clip.duration}};
    const bool turns = std::any_of(scene.cameras.begin(), scene.cameras.end(),
                                   [](const Camera& camera) { return camera.orbit != 0; });
    if (!turns) json.erase("duration");
    for (const NamedPicture& picture : look_pictures(scene.look))
        json["textures"].push_back(texture_hash((options.textures / picture.file).string()));
    return json.dump(2) + "\n";
}

bool holds_other_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp) {
    return text_if_there(stamp_file(folder, view)) != stamp && !pictures_of(folder, view).empty();
}

int count_pictures(const RunFolder& folder, const std::string& view) {
    return static_cast<int>(pictures_of(folder, view).size());
}

bool stamp_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp,
                    bool whole_clip) {
    const fs::path file = stamp_file(folder, view);
    if (fs::exists(file)) {
        const std::vector<std::uint8_t> before = read_whole_file(file, largest_stamp);
        if (std::string(before.begin(), before.end()) == stamp) return true;
        // First of all: were the program to end here, nothing would vouch for the old pictures.
        fs::remove(file);
    }
    remove_range_files(folder, view);
    if (whole_clip) write_whole_file(file, stamp);
    return false;
}

void adopt_pictures(const RunFolder& from, const RunFolder& to, const std::string& view) {
    // First of all: were the program to end on the way, nothing would vouch for what lies there.
    fs::remove(stamp_file(to, view));
    remove_range_files(to, view);
    int last = -1;
    for (const auto& [frame, file] : pictures_of(from, view)) {
        move_file(file, to.picture(view, frame));
        last = std::max(last, frame);
    }
    remove_pictures_beyond(to, view, last);
    move_file(stamp_file(from, view), stamp_file(to, view));
}

void remove_pictures_beyond(const RunFolder& folder, const std::string& view, int last) {
    for (const auto& [frame, file] : pictures_of(folder, view)) {
        if (frame > last) fs::remove(file);
    }
}

bool keep_or_clear_range(const RunFolder& folder, const std::string& view, const std::string& stamp,
                         const FrameRange& range) {
    const fs::path file = range_file(folder, view, range);
    if (text_if_there(file) == stamp) return true;
    fs::remove(file);
    for (int k = range.first; k <= range.last; ++k)
        fs::remove(folder.frames() / fmt::format("{}_{:04}.png", view, k));
    write_whole_file(file, stamp);
    return false;
}

std::string stamp_of_range(const RunFolder& folder, const std::string& view, const FrameRange& range) {
    const std::string own = text_if_there(range_file(folder, view, range));
    return own.empty() ? text_if_there(stamp_file(folder, view)) : own;
}

void keep_ranges(const RunFolder& folder, const std::string& view, const std::string& stamp,
                 const std::vector<FrameRange>& ranges) {
    const auto is_this = [&](const std::string& text) {
        return !text.empty() && without_renderer(text) == without_renderer(stamp);
    };
    const std::string whole = text_if_there(stamp_file(folder, view));
    std::set<fs::path> files;
    for (const FrameRange& range : ranges) {
        files.insert(range_file(folder, view, range));
        if (is_this(whole)) write_whole_file(range_file(folder, view, range), whole);
    }
    fs::remove(stamp_file(folder, view));
    remove_range_files(folder, view, [&](const fs::path& file) {
        return files.contains(file) && is_this(text_if_there(file));
    });
}

std::string without_renderer(const std::string& stamp) {
    auto json = nlohmann::ordered_json::parse(stamp, nullptr, false);
    if (!json.is_object()) return {};
    json.erase("renderer");
    return json.dump();
}

std::string renderer_in(const std::string& stamp) {
    const auto json = nlohmann::ordered_json::parse(stamp, nullptr, false);
    return json.is_object() ? json.value("renderer", "") : std::string();
}

}  // namespace unravel::tool
