#include "sim/scene_file/reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/schema.hpp"
#include "sim/scene_file/similar.hpp"

namespace unravel::sim {

// ---- Bookkeeping -----------------------------------------------------------------------------------------

std::string Reader::path_of(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

void Reader::know(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
}

void Reader::report(std::string_view key, SourcePlace place, std::string what, std::string hint) {
    if (shared_.problems.size() >= max_problems) return;
    shared_.places.mark_bad(path_of(key));
    shared_.problems.push_back({place, std::move(what), std::move(hint)});
}

void Reader::problem(std::string_view key, std::string what, std::string hint) {
    SourcePlace where;
    place(where, key);
    report(key, where, std::move(what), std::move(hint));
}

void Reader::place(SourcePlace& place, std::string_view key) const {
    const Entry* entry = table_.find(key);
    place = entry ? entry->value.place : table_.place;
}

const Node* Reader::take(const Key& key) {
    know(key.name);
    const Entry* entry = table_.find(key.name);
    if (!entry) {
        if (key.required)
            report(key.name, table_.place,
                   fmt::format("{} '{}'", path_.empty() ? "the scene has no" : "missing key", key.name),
                   path_.empty() ? fmt::format("write a table [{}]", key.name)
                                 : fmt::format("write {} = … ({})", key.name, key.doc));
        return nullptr;
    }
    if (!key.applies) {
        report(key.name, entry->place, fmt::format("'{}' does not belong here", key.name),
               std::string(key.doc));
        return nullptr;
    }
    shared_.places.add(path_of(key.name), entry->value.place);
    return &entry->value;
}

bool Reader::creates(const Key& key) {
    know(key.name);
    return says(key.name);
}

void Reader::exactly_one(std::initializer_list<std::string_view> keys) {
    const Entry* first = nullptr;
    for (const std::string_view key : keys) {
        const Entry* entry = table_.find(key);
        if (!entry) continue;
        if (first)
            report(key, entry->place, fmt::format("'{}' beside '{}'", key, first->key),
                   "only one of them can hold");
        else
            first = entry;
    }
    if (!first)
        report(*keys.begin(), table_.place, "missing key",
               "say one of " + one_of({keys.begin(), keys.size()}, '\''));
}

void Reader::finish() {
    for (const Entry& entry : table_.entries) {
        if (shared_.problems.size() >= max_problems) return;
        if (std::find(known_.begin(), known_.end(), entry.key) == known_.end()) report_unknown(entry);
    }
}

void Reader::report_unknown(const Entry& entry) {
    std::string hint;
    const std::string_view near = most_similar(entry.key, known_, 1);
    if (shared_.tables_of_keys.empty()) shared_.tables_of_keys = tables_of_keys();
    const auto elsewhere = shared_.tables_of_keys.find(entry.key);
    const std::string_view far = most_similar(entry.key, known_);
    if (!near.empty() && entry.key.size() > 2) {
        hint = fmt::format("did you mean '{}'?", near);
    } else if (elsewhere != shared_.tables_of_keys.end()) {
        const std::vector<std::string_view> views(elsewhere->second.begin(), elsewhere->second.end());
        hint = fmt::format("it belongs in {}",
                           one_of(std::span(views).first(std::min<std::size_t>(3, views.size())), '\0'));
    } else if (!far.empty()) {
        hint = fmt::format("did you mean '{}'?", far);
    } else {
        hint = "known here: ";
        for (std::size_t i = 0; i < known_.size(); ++i) hint += (i ? ", " : "") + std::string(known_[i]);
    }
    report(entry.key, entry.place, fmt::format("unknown key '{}'", printable(entry.key.substr(0, 64))), hint);
}

// ---- Single values ---------------------------------------------------------------------------------------

bool Reader::wrong_kind(std::string_view key, const Node& value, std::string_view wanted) {
    report(key, value.place, fmt::format("'{}' must be {}, not {}", key, wanted, kind_name(value.kind)));
    return false;
}

bool Reader::read_number(std::string_view key, const Node& value, const Bounds& bounds, double& out) {
    if (!value.is(Node::Kind::integer) && !value.is(Node::Kind::number))
        return wrong_kind(key, value, "a number");
    const double number = value.number;
    if (std::isfinite(number) && number <= bounds.high &&
        (bounds.above_low ? number > bounds.low : number >= bounds.low)) {
        out = number;
        return true;
    }
    const std::string unit = bounds.unit.empty() ? std::string() : fmt::format(" {}", bounds.unit);
    const std::string range =
        bounds.above_low
            ? fmt::format("it must be above {:g} and at most {:g}{}", bounds.low, bounds.high, unit)
            : fmt::format("it must be from {:g} to {:g}{}", bounds.low, bounds.high, unit);
    if (std::isnan(number))
        report(key, value.place, fmt::format("'{}' is nan, not a number", key), range);
    else if (std::isinf(number))
        report(key, value.place, fmt::format("'{}' is infinite", key), range);
    else
        report(key, value.place, fmt::format("'{}' is {}", key, number), range);
    return false;
}

bool Reader::read_integer(std::string_view key, const Node& value, std::int64_t low, std::int64_t high,
                          std::int64_t& out) {
    if (!value.is(Node::Kind::integer)) return wrong_kind(key, value, "a whole number");
    if (value.integer < low || value.integer > high) {
        report(key, value.place, fmt::format("'{}' is {}", key, value.integer),
               fmt::format("it must be from {} to {}", low, high));
        return false;
    }
    out = value.integer;
    return true;
}

int Reader::read_word(std::string_view key, const Node& value, std::span<const std::string_view> words) {
    if (!value.is(Node::Kind::text)) {
        wrong_kind(key, value, "one of the words " + one_of(words, '"'));
        return -1;
    }
    const auto found = std::find(words.begin(), words.end(), value.text);
    if (found != words.end()) return static_cast<int>(found - words.begin());
    const std::string_view meant = most_similar(value.text, words);
    report(key, value.place, fmt::format("'{}' can't be \"{}\"", key, printable(value.text.substr(0, 64))),
           meant.empty() ? "it is " + one_of(words, '"') : fmt::format("did you mean \"{}\"?", meant));
    return -1;
}

void Reader::flag(const Key& key, bool& out) {
    const Node* value = take(key);
    if (!value) return;
    if (value->is(Node::Kind::flag))
        out = value->flag;
    else
        wrong_kind(key.name, *value, "true or false");
}

void Reader::integer(const Key& key, int& out, int low, int high) {
    std::int64_t number = out;
    if (const Node* value = take(key)) read_integer(key.name, *value, low, high, number);
    out = static_cast<int>(number);
}

void Reader::seed(const Key& key, std::uint32_t& out) {
    std::int64_t number = out;
    if (const Node* value = take(key)) read_integer(key.name, *value, 0, 0xFFFFFFFF, number);
    out = static_cast<std::uint32_t>(number);
}

void Reader::number(const Key& key, double& out, const Bounds& bounds) {
    if (const Node* value = take(key)) read_number(key.name, *value, bounds, out);
}

void Reader::optional_number(const Key& key, std::optional<double>& out, const Bounds& bounds) {
    double number = 0;
    if (const Node* value = take(key); value && read_number(key.name, *value, bounds, number)) out = number;
}

namespace {

// "a/b" of two whole numbers above zero.
bool parse_quotient(const std::string& text, int& above, int& below) {
    const char* end = text.data() + text.size();
    const auto [slash, bad_above] = std::from_chars(text.data(), end, above);
    if (bad_above != std::errc() || slash == end || *slash != '/') return false;
    const auto [rest, bad_below] = std::from_chars(slash + 1, end, below);
    return bad_below == std::errc() && rest == end && above > 0 && below > 0;
}

}  // namespace

void Reader::rate(const Key& key, Rate& out, int low, int high) {
    const Node* value = take(key);
    if (!value) return;
    const std::string_view hint = "write a whole number or a fraction of two such as \"30000/1001\"";
    if (value->is(Node::Kind::text)) {
        int above = 0, below = 0;
        if (!parse_quotient(value->text, above, below)) {
            report(key.name, value->place,
                   fmt::format("'{}' can't be \"{}\"", key.name, printable(value->text.substr(0, 64))),
                   std::string(hint));
        } else if (above < static_cast<double>(low) * below || above > static_cast<double>(high) * below) {
            report(key.name, value->place, fmt::format("'{}' is {}/{}", key.name, above, below),
                   fmt::format("it must be from {} to {}", low, high));
        } else {
            out = Rate(above, below);
        }
        return;
    }
    if (value->is(Node::Kind::number)) {
        report(key.name, value->place,
               fmt::format("'{}' is no exact number of frames as {}", key.name, value->number),
               std::string(hint));
        return;
    }
    std::int64_t number = 0;
    if (read_integer(key.name, *value, low, high, number)) out = static_cast<int>(number);
}

void Reader::fraction(const Key& key, double& out, const Bounds& bounds) {
    const Node* value = take(key);
    if (!value) return;
    if (!value->is(Node::Kind::text)) {
        read_number(key.name, *value, bounds, out);
        return;
    }
    int above = 0, below = 0;
    if (parse_quotient(value->text, above, below)) {
        Node quotient = *value;
        quotient.kind = Node::Kind::number;
        quotient.number = static_cast<double>(above) / below;
        read_number(key.name, quotient, bounds, out);
        return;
    }
    report(key.name, value->place,
           fmt::format("'{}' can't be \"{}\"", key.name, printable(value->text.substr(0, 64))),
           "write a number or a fraction of whole numbers such as \"1/240\"");
}

void Reader::text(const Key& key, std::string& out, TextKind kind) {
    if (const Node* value = take(key)) read_text(key.name, *value, kind, out);
}

bool Reader::read_text(std::string_view key, const Node& value, TextKind kind, std::string& out) {
    if (!value.is(Node::Kind::text)) return wrong_kind(key, value, "a text");
    const std::string& text = value.text;
    std::string_view hint;
    if (kind == TextKind::color && (text.size() != 7 || text[0] != '#' ||
                                    text.find_first_not_of("0123456789abcdefABCDEF", 1) != text.npos))
        hint = "write a colour as \"#rrggbb\"";
    if (kind == TextKind::name && (text.empty() || text.size() > 64)) hint = "write 1 to 64 characters";
    if (kind == TextKind::path && (text.empty() || text.size() > 1024)) hint = "write 1 to 1024 characters";
    if (printable(text) != text) hint = "it has control characters";
    if (hint.empty()) {
        out = text;
        return true;
    }
    report(key, value.place, fmt::format("'{}' can't be \"{}\"", key, printable(text.substr(0, 64))),
           std::string(hint));
    return false;
}

void Reader::word(const Key& key, std::string& out, std::span<const std::string_view> words) {
    int index = -1;
    if (const Node* value = take(key)) index = read_word(key.name, *value, words);
    if (index >= 0) out = words[static_cast<std::size_t>(index)];
}

void Reader::choose(const Key& key, int& out, std::span<const std::string_view> words) {
    int index = -1;
    if (const Node* value = take(key)) index = read_word(key.name, *value, words);
    if (index >= 0) out = index;
}

}  // namespace unravel::sim
