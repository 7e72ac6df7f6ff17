#include "sim/scene_file/unfit_text.hpp"

#include <fmt/core.h>

#include "sim/scene/limits.hpp"

namespace unravel::sim {

namespace {

bool is_ascii(char c) {
    return static_cast<unsigned char>(c) < 0x80;
}

/// Whether the byte begins a character in UTF-8.
bool begins_character(char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}

/// Where the text that begins with the quote at `at` ends: at its closing quote, or before the end of the
/// line.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
    const char quote = text[at];
    for (std::size_t i = at + 1; i < text.size(); ++i) {
        if (text[i] == '\n') return i - 1;
        if (text[i] == quote) return i;
        if (quote == '"' && text[i] == '\\' && i + 1 < text.size() && text[i + 1] != '\n') ++i;
    }
    return text.size() - 1;
}

}  // namespace

std::optional<SceneProblem> unfit_text(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    SourcePlace place{1, 0, 0};
    const auto pass = [&](char c) {
        if (c == '\n')
            place = {place.line + 1, 0, 0};
        else if (begins_character(c))
            ++place.column;
    };
    std::size_t dots = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        pass(c);
        std::size_t end = i;  // of what is skipped
        if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '[') dots = 0;
        if (c == '.' && ++dots >= max_key_parts)
            return SceneProblem{place, fmt::format("a key of more than {} parts", max_key_parts), ""};
        if (!is_ascii(c))
            return SceneProblem{place, "a character beyond ASCII outside of a text", "put it in quotes"};
        if (c == '"' || c == '\'') {
            if (text.substr(i, 3) == std::string(3, c))
                return SceneProblem{place, "a text in three quotes", "write it on one line as \"…\""};
            end = end_of_quoted(text, i);
        }
        if (c == '#') end = std::min(text.find('\n', i), text.size()) - 1;
        while (i < end) pass(text[++i]);
    }
    return {};
}

}  // namespace unravel::sim
