#include "sim/scene_file/diagnostics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

namespace unravel::sim {

namespace {

constexpr std::size_t most_shown = 50;
constexpr std::size_t shown_width = 100;  // of a line, in characters

/// The n-th line (1-based) without its end; empty past the end.
std::string_view line_of(std::string_view text, int line) {
    for (; line > 1; --line) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        text.remove_prefix(end + 1);
    }
    text = text.substr(0, text.find('\n'));
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
}

bool starts_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
}

/// Characters of a line as shown one per column: UTF-8 sequences stay together, tabs become one blank.
std::vector<std::string> characters(std::string_view line) {
    std::vector<std::string> out;
    for (const char byte : line) {
        if (starts_character(byte) || out.empty()) out.emplace_back();
        out.back() += byte;
    }
    for (std::string& character : out) character = character == "\t" ? " " : printable(character);
    return out;
}

bool in_word(const std::string& character) {
    if (character.size() != 1) return false;
    const unsigned char c = static_cast<unsigned char>(character[0]);
    return std::isalnum(c) || c == '_' || c == '.' || c == '-' || c == '+' || c == '#';
}

/// The offending line with a caret; of a long line the part around the column.
std::string excerpt(std::string_view line, int column, const std::string& margin) {
    const std::vector<std::string> all = characters(line);
    const std::size_t at = std::min<std::size_t>(std::max(column - 1, 0), all.size());
    const std::size_t begin = at > shown_width / 2 && all.size() > shown_width ? at - shown_width / 2 : 0;
    const std::size_t end = std::min(all.size(), begin + shown_width);
    std::string shown = begin > 0 ? "..." : "";
    std::string caret(shown.size() + at - begin, ' ');
    for (std::size_t i = begin; i < end; ++i) shown += all[i];
    if (end < all.size()) shown += "...";
    caret += '^';
    if (at < end && in_word(all[at])) {
        for (std::size_t i = at + 1; i < end && in_word(all[i]); ++i) caret += '~';
    }
    const std::string blank(margin.size(), ' ');
    return fmt::format("{} | {}\n{} | {}\n", margin, shown, blank, caret);
}

std::string format_one(const SceneProblem& problem, const Sources& sources) {
    const SourcePlace& place = problem.place;
    const std::string message =
        problem.hint.empty() ? problem.what : fmt::format("{}; {}", problem.what, problem.hint);
    if (place.option > 0) {
        const std::string_view option = sources.options[static_cast<std::size_t>(place.option) - 1];
        return fmt::format("--set #{} ({}): error: {}\n{}", place.option, printable(option.substr(0, 60)),
                           message, excerpt(option, place.column, "     "));
    }
    const IncludedFile* included =
        place.file > 0 ? &sources.included[static_cast<std::size_t>(place.file) - 1] : nullptr;
    const std::string_view text = included ? std::string_view(included->text) : sources.text;
    return fmt::format("{}:{}:{}: error: {}\n{}", included ? included->name : sources.name, place.line,
                       place.column, message,
                       excerpt(line_of(text, place.line), place.column, fmt::format("{:>5}", place.line)));
}

}  // namespace

std::string printable(std::string_view text) {
    std::string out;
    for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    return out;
}

std::string format_problems(std::vector<SceneProblem> problems, const Sources& sources) {
    const auto key = [](const SceneProblem& p) {
        return std::tuple(p.place.option, p.place.file, p.place.line, p.place.column);
    };
    std::stable_sort(problems.begin(), problems.end(),
                     [&](const auto& a, const auto& b) { return key(a) < key(b); });
    std::string out;
    for (std::size_t i = 0; i < std::min(problems.size(), most_shown); ++i)
        out += format_one(problems[i], sources);
    if (problems.size() > most_shown)
        out += fmt::format("... and {} more problems\n", problems.size() - most_shown);
    out += problems.size() == 1 ? "1 problem in the scene"
                                : fmt::format("{} problems in the scene", problems.size());
    return out;
}

void Places::repeat(const std::string& from, const std::string& to) {
    const auto inside = [&](const std::string& path) {
        return path.starts_with(from) &&
               (path.size() == from.size() || path[from.size()] == '.' || path[from.size()] == '[');
    };
    std::vector<std::pair<std::string, SourcePlace>> places;
    for (auto at = places_.lower_bound(from); at != places_.end() && at->first.starts_with(from); ++at)
        if (inside(at->first)) places.emplace_back(to + at->first.substr(from.size()), at->second);
    places_.insert(places.begin(), places.end());
    std::vector<std::string> bad;
    for (auto at = bad_.lower_bound(from); at != bad_.end() && at->starts_with(from); ++at)
        if (inside(*at)) bad.push_back(to + at->substr(from.size()));
    bad_.insert(bad.begin(), bad.end());
}

SourcePlace Places::at(std::string path) const {
    while (true) {
        if (const auto found = places_.find(path); found != places_.end()) return found->second;
        const std::size_t cut = path.find_last_of(".[");
        if (cut == std::string::npos) return {1, 1, 0};
        path.resize(cut);
    }
}

bool Places::sound(const std::string& path) const {
    const auto found = bad_.lower_bound(path);
    if (found != bad_.end() && *found == path) return false;
    for (const char next : {'.', '['}) {
        const auto inside = bad_.lower_bound(path + next);
        if (inside != bad_.end() && inside->starts_with(path + next)) return false;
    }
    return true;
}

bool Places::sound_itself(const std::string& table) const {
    const std::string prefix = table + '.';
    for (auto at = bad_.lower_bound(prefix); at != bad_.end() && at->starts_with(prefix); ++at) {
        if (at->find_first_of(".[", prefix.size()) == std::string::npos) return false;
    }
    return true;
}

}  // namespace unravel::sim
