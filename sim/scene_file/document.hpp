#pragma once

// TOML text as a plain tree with the place of every key and value. The one file that knows the TOML library
// is document.cpp.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene_file/load.hpp"

namespace unravel::sim {

struct Entry;

struct Node {
    enum class Kind { flag, integer, number, text, date, list, table };
    Kind kind = Kind::table;
    SourcePlace place;
    bool flag = false;
    std::int64_t integer = 0;
    double number = 0;  ///< also of an integer
    std::string text;
    std::vector<Node> items;     ///< of a list
    std::vector<Entry> entries;  ///< of a table, by place

    bool is(Kind wanted) const { return kind == wanted; }
    const Entry* find(std::string_view key) const;
    Entry* find(std::string_view key);
};

struct Entry {
    std::string key;
    SourcePlace place;  ///< of the key
    Node value;
};

/// "a whole number", "a text", "a list" …
std::string_view kind_name(Node::Kind);

/// Parses a whole text. Where it can't be read (syntax, nesting), the problem is added and false returned.
bool parse_document(std::string_view text, Node& root, std::vector<SceneProblem>& problems);

/// Parses one value, as the text that follows the '=' of an option; places get `option` and are moved right
/// by `shift` columns. Returns false with nothing added if it is no TOML value.
bool parse_value(std::string_view text, int option, int shift, Node& value);

}  // namespace unravel::sim
