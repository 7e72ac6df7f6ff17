#include "tool/study/stability/stability_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "sim/run/frame_record.hpp"
#include "tool/base/version.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t largest_piece = 16 << 20;

fs::path case_file(const fs::path& output, const std::string& name) {
    return output / "points" / (name + ".json");
}

fs::path map_file(const fs::path& output, const std::string& integrator) {
    return output / "points" / ("map_" + integrator + ".json");
}

// What a piece depends on, in a number; nothing where the scene can't be read.
std::string key_of(const fs::path& scene, const std::string& rest) {
    std::string text = version() + rest;
    if (fs::exists(scene)) text += read_whole_text(scene, largest_piece);
    return fmt::format("{:016x}", hash_bytes(text.data(), text.size()));
}

std::string key_of(const HardCase& hard, bool pictures) {
    return key_of(hard.scene, fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", fmt::join(hard.set, "|"),
                                          static_cast<int>(hard.must), hard.says, hard.strain, hard.energy,
                                          hard.fed, hard.rest, hard.penetration, hard.flicker, hard.chatter,
                                          hard.jitter, hard.allow_unstable, pictures));
}

void write_piece(const fs::path& file, const std::string& key, Json content) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) throw OutputError(file.parent_path(), error.value());
    write_whole_file(file, Json{{"made_from", key}, {"result", std::move(content)}}.dump(2) + "\n");
}

std::optional<Json> read_piece(const fs::path& file, const std::string& key) {
    if (!fs::is_regular_file(file)) return {};
    const Json json = Json::parse(read_whole_text(file, largest_piece), nullptr, false);
    if (!json.is_object() || json.value("made_from", "") != key || !json.contains("result")) return {};
    return json["result"];
}

// JSON has no word for what is not finite.
double number(const Json& json, const char* key) {
    return json.at(key).is_number() ? json.at(key).get<double>() : std::numeric_limits<double>::infinity();
}

HardOutcome outcome_of(const Json& json) {
    HardOutcome out;
    const auto ended = json.at("ended").get<std::string>();
    using Kind = HardOutcome::Kind;
    out.kind = ended == "survived" ? Kind::survived : ended == "refused" ? Kind::refused : Kind::stopped;
    out.says = json.at("says").get<std::string>();
    out.failures = json.at("failures").get<std::vector<std::string>>();
    out.particles = json.at("particles").get<std::size_t>();
    out.steps = json.at("steps").get<std::uint64_t>();
    out.max_strain = number(json, "max_strain");
    out.energy_rise = number(json, "energy_rise");
    out.again = json.at("steps_taken_again").get<std::uint64_t>();
    out.flicker = number(json, "flicker");
    out.chatter = number(json, "chatter");
    out.jitter = number(json, "jitter");
    out.penetration = number(json, "penetration");
    out.pin_error = number(json, "pin_error");
    out.final_speed = number(json, "final_speed");
    out.cg_most = json.at("cg_iterations_max").get<std::uint32_t>();
    out.unconverged = json.at("unconverged_steps").get<std::uint64_t>();
    out.hash = std::stoull(json.at("hash").get<std::string>(), nullptr, 16);
    out.same_bits = json.at("same_bits_1_2_threads").get<bool>();
    out.seconds = number(json, "seconds");
    return out;
}

}  // namespace

void write_hard_line(const fs::path& output, const HardLine& line, bool pictures) {
    write_piece(case_file(output, line.hard.name), key_of(line.hard, pictures), stability_json(line));
}

std::optional<HardLine> read_hard_line(const fs::path& output, const HardCase& hard, bool pictures) {
    const std::optional<Json> json = read_piece(case_file(output, hard.name), key_of(hard, pictures));
    if (!json) return {};
    try {
        HardLine line{hard, outcome_of(*json), json->at("picture").get<std::string>()};
        if (!line.picture.empty() && !fs::exists(output / line.picture)) return {};
        return line;
    } catch (const std::exception&) {
        return {};  // of another version, or damaged
    }
}

void write_map_piece(const fs::path& output, const fs::path& scene, const StabilityMap& map) {
    Json cells = Json::array();
    for (const MapCell& cell : map.cells) cells.push_back({cell.stretch, cell.step, cell.kappa, cell.stable});
    write_piece(map_file(output, map.integrator), key_of(scene, map.integrator), std::move(cells));
}

std::optional<StabilityMap> read_map_piece(const fs::path& output, const fs::path& scene,
                                           const std::string& integrator) {
    const std::optional<Json> json = read_piece(map_file(output, integrator), key_of(scene, integrator));
    if (!json) return {};
    try {
        StabilityMap map{integrator, {}};
        for (const Json& cell : *json) {
            map.cells.push_back({cell.at(0).get<double>(), cell.at(1).get<double>(), cell.at(2).get<double>(),
                                 cell.at(3).get<bool>()});
        }
        return map;
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace unravel::tool
