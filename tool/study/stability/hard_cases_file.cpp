#include <fmt/format.h>

#include <toml++/toml.h>

#include "base/file_errors.hpp"
#include "base/whole_file.hpp"
#include "tool/study/stability/hard_case.hpp"

namespace unravel::tool {

namespace {

constexpr std::size_t largest_list = 1 << 20;

Must parse_must(const std::string& word, const std::filesystem::path& file, const std::string& name) {
    if (word == "survive") return Must::survive;
    if (word == "refuse") return Must::refuse;
    if (word == "stop") return Must::stop;
    throw InputError(file,
                     fmt::format("case '{}': must = \"{}\": there is survive, refuse and stop", name, word));
}

}  // namespace

std::vector<HardCase> read_hard_cases(const std::filesystem::path& file) {
    const std::vector<std::uint8_t> bytes = read_whole_file(file, largest_list);
    toml::table root;
    try {
        root = toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    } catch (const toml::parse_error& error) {
        throw InputError(file, fmt::format("line {}: {}", error.source().begin.line, error.description()));
    }
    const toml::array* list = root["case"].as_array();
    if (!list) throw InputError(file, "it lists no [[case]]");
    std::vector<HardCase> cases;
    for (const toml::node& node : *list) {
        const toml::table& t = *node.as_table();
        HardCase c;
        c.name = t["name"].value_or(std::string());
        c.what = t["what"].value_or(std::string());
        c.scene = file.parent_path() / t["scene"].value_or(c.name + ".toml");
        if (const toml::array* set = t["set"].as_array()) {
            for (const toml::node& item : *set) c.set.push_back(item.value_or(std::string()));
        }
        c.must = parse_must(t["must"].value_or(std::string("survive")), file, c.name);
        c.says = t["says"].value_or(std::string());
        c.strain = t["strain"].value_or(c.strain);
        c.energy = t["energy"].value_or(c.energy);
        c.swing = t["swing"].value_or(c.swing);
        c.fed = t["fed"].value_or(c.fed);
        c.rest = t["rest"].value_or(c.rest);
        c.penetration = t["penetration"].value_or(c.penetration);
        c.flicker = t["flicker"].value_or(c.flicker);
        c.chatter = t["chatter"].value_or(c.chatter);
        c.jitter = t["jitter"].value_or(c.jitter);
        c.frames = static_cast<int>(t["frames"].value_or(std::int64_t{0}));
        c.allow_unstable = t["allow_unstable"].value_or(false);
        if (c.name.empty() || c.what.empty()) throw InputError(file, "a case without name or what");
        if (c.must != Must::survive && c.says.empty())
            throw InputError(file, fmt::format("case '{}' names no cause (says)", c.name));
        cases.push_back(std::move(c));
    }
    return cases;
}

}  // namespace unravel::tool
