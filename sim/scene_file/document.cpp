#include "sim/scene_file/document.hpp"

// The library's own limit is 256; ours has to hold for the recursion of everything that walks the tree.
#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

#include "sim/scene_file/unfit_text.hpp"

namespace unravel::sim {

namespace {

SourcePlace place_of(const toml::source_region& region) {
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), 0};
}

Node convert(const toml::node& node);

Node convert_table(const toml::table& table) {
    Node out;
    for (const auto& [key, value] : table)
        out.entries.push_back({std::string(key.str()), place_of(key.source()), convert(value)});
    // The library sorts by key; problems read better in the order of the file.
    std::stable_sort(out.entries.begin(), out.entries.end(), [](const Entry& a, const Entry& b) {
        return std::tuple(a.place.line, a.place.column) < std::tuple(b.place.line, b.place.column);
    });
    return out;
}

Node convert(const toml::node& node) {
    Node out;
    if (const toml::table* table = node.as_table()) {
        out = convert_table(*table);
    } else if (const toml::array* array = node.as_array()) {
        out.kind = Node::Kind::list;
        for (const toml::node& item : *array) out.items.push_back(convert(item));
    } else if (const auto* flag = node.as_boolean()) {
        out.kind = Node::Kind::flag;
        out.flag = flag->get();
    } else if (const auto* integer = node.as_integer()) {
        out.kind = Node::Kind::integer;
        out.integer = integer->get();
        out.number = static_cast<double>(out.integer);
    } else if (const auto* number = node.as_floating_point()) {
        out.kind = Node::Kind::number;
        out.number = number->get();
    } else if (const auto* text = node.as_string()) {
        out.kind = Node::Kind::text;
        out.text = text->get();
    } else {
        out.kind = Node::Kind::date;
    }
    out.place = place_of(node.source());
    return out;
}

/// The library's words without what only its programmers need.
std::string reason(std::string_view description) {
    if (description.find("maximum nested value depth") != std::string_view::npos)
        return "lists and tables are nested too deep";
    constexpr std::string_view opening = "Error while parsing ";
    if (description.starts_with(opening)) description.remove_prefix(opening.size());
    return std::string(description);
}

void move_to_option(Node& node, int option, int shift) {
    const auto move = [&](SourcePlace& place) { place = {1, place.column + shift, option}; };
    move(node.place);
    for (Node& item : node.items) move_to_option(item, option, shift);
    for (Entry& entry : node.entries) {
        move(entry.place);
        move_to_option(entry.value, option, shift);
    }
}

}  // namespace

const Entry* Node::find(std::string_view key) const {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.key == key; });
    return found == entries.end() ? nullptr : &*found;
}

Entry* Node::find(std::string_view key) {
    return const_cast<Entry*>(static_cast<const Node*>(this)->find(key));
}

std::string_view kind_name(Node::Kind kind) {
    switch (kind) {
        case Node::Kind::flag:
            return "true or false";
        case Node::Kind::integer:
            return "a whole number";
        case Node::Kind::number:
            return "a decimal number";
        case Node::Kind::text:
            return "a text";
        case Node::Kind::date:
            return "a date or time";
        case Node::Kind::list:
            return "a list";
        case Node::Kind::table:
            return "a table";
    }
    return "";
}

bool parse_document(std::string_view text, Node& root, std::vector<SceneProblem>& problems) {
    if (std::optional<SceneProblem> problem = unfit_text(text)) {
        problems.push_back(std::move(*problem));
        return false;
    }
    try {
        root = convert_table(toml::parse(text));
        root.place = {1, 1, 0};
        return true;
    } catch (const toml::parse_error& error) {
        problems.push_back({place_of(error.source()), "this is not TOML", reason(error.description())});
        return false;
    }
}

bool parse_value(std::string_view text, int option, int shift, Node& value) {
    const std::string line = "v=" + std::string(text);
    if (unfit_text(line)) return false;
    try {
        const toml::table table = toml::parse(line);
        if (table.size() != 1) return false;
        value = convert(*table.get("v"));
        move_to_option(value, option, shift - 2);
        return true;
    } catch (const toml::parse_error&) {
        return false;
    }
}

}  // namespace unravel::sim
