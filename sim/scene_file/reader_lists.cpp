// The part of the reader that reads lists and nested tables.

#include <fmt/core.h>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/reader.hpp"

namespace unravel::sim {

void Reader::integers(const Key& key, std::span<int> out, int low, int high) {
    const Node* value = take(key);
    if (!value) return;
    const std::string wanted = fmt::format("a list of {} whole numbers", out.size());
    if (!value->is(Node::Kind::list)) {
        wrong_kind(key.name, *value, wanted);
        return;
    }
    if (value->items.size() != out.size()) {
        report(key.name, value->place,
               fmt::format("'{}' must be {}, not of {}", key.name, wanted, value->items.size()));
        return;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::int64_t number = out[i];
        read_integer(key.name, value->items[i], low, high, number);
        out[i] = static_cast<int>(number);
    }
}

void Reader::numbers(const Key& key, std::span<double> out, const Bounds& bounds) {
    const Node* value = take(key);
    if (!value) return;
    const std::string wanted = fmt::format("a list of {} numbers", out.size());
    if (!value->is(Node::Kind::list)) {
        wrong_kind(key.name, *value, wanted);
        return;
    }
    if (value->items.size() != out.size()) {
        report(key.name, value->place,
               fmt::format("'{}' must be {}, not of {}", key.name, wanted, value->items.size()));
        return;
    }
    for (std::size_t i = 0; i < out.size(); ++i) read_number(key.name, value->items[i], bounds, out[i]);
}

void Reader::number_or_pair(const Key& key, std::array<double, 2>& out, const Bounds& bounds) {
    const Entry* entry = table_.find(key.name);
    if (entry && entry->value.is(Node::Kind::list)) {
        numbers(key, out, bounds);
    } else if (const Node* value = take(key)) {
        double number = 0;
        if (!value->is(Node::Kind::integer) && !value->is(Node::Kind::number))
            wrong_kind(key.name, *value, "a number or a list of 2 numbers");
        else if (read_number(key.name, *value, bounds, number))
            out = {number, number};
    }
}

void Reader::texts(const Key& key, std::vector<std::string>& out, TextKind kind) {
    const Node* value = take(key);
    if (!value) return;
    const bool list = value->is(Node::Kind::list);
    std::vector<std::string> read(list ? value->items.size() : 1);
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (!read_text(key.name, list ? value->items[i] : *value, kind, read[i])) return;
    }
    out = std::move(read);
}

void Reader::words(const Key& key, std::vector<std::string>& out, std::span<const std::string_view> words) {
    const Node* value = take(key);
    if (!value) return;
    std::vector<std::string> read;
    const auto add = [&](const Node& node) {
        if (const int index = read_word(key.name, node, words); index >= 0)
            read.emplace_back(words[static_cast<std::size_t>(index)]);
    };
    if (value->is(Node::Kind::list)) {
        if (value->items.empty())
            report(key.name, value->place, fmt::format("'{}' is an empty list", key.name),
                   "name at least one");
        if (value->items.size() > words.size())
            report(
                key.name, value->place,
                fmt::format("'{}' has {} words, there are {}", key.name, value->items.size(), words.size()));
        else
            for (const Node& item : value->items) add(item);
    } else {
        add(*value);
    }
    if (!read.empty()) out = std::move(read);
}

void Reader::read_table(const std::string& path, const Node& value,
                        const std::function<void(Fields&)>& describe) {
    shared_.places.add(path, value.place);
    Reader nested(value, path, shared_);
    describe(nested);
    nested.finish();
}

void Reader::table(const Key& key, const std::function<void(Fields&)>& describe) {
    const Node* value = take(key);
    if (!value) return;
    if (value->is(Node::Kind::table))
        read_table(path_of(key.name), *value, describe);
    else
        wrong_kind(key.name, *value, "a table");
}

bool Reader::number_or_table(const Key& key, double& out, const Bounds& bounds,
                             const std::function<void(Fields&)>& describe) {
    const Entry* entry = table_.find(key.name);
    if (entry && entry->value.is(Node::Kind::table)) {
        table(key, describe);
        return false;
    }
    const Node* value = take(key);
    return value && read_number(key.name, *value, bounds, out);
}

void Reader::items(const Key& key, std::size_t /*count*/, const std::function<void(std::size_t)>& resize,
                   const std::function<void(Fields&, std::size_t)>& item, ListForm layout) {
    const Node* value = take(key);
    if (!value) return;
    const std::string path = path_of(key.name);
    if (value->is(Node::Kind::table) && layout == ListForm::tables) {
        resize(1);
        read_table(path + "[0]", *value, [&](Fields& nested) { item(nested, 0); });
        return;
    }
    if (!value->is(Node::Kind::list)) {
        wrong_kind(key.name, *value,
                   layout == ListForm::tables ? "a table or a list of tables" : "a list of tables");
        return;
    }
    if (value->items.size() > max_list) {
        report(key.name, value->place, fmt::format("{} '{}'", value->items.size(), key.name),
               fmt::format("at most {}", max_list));
        return;
    }
    if (value->items.empty() && key.required)
        report(key.name, value->place, fmt::format("the scene has no '{}'", key.name),
               fmt::format("write a table [{}]", key.name));
    resize(value->items.size());
    for (std::size_t i = 0; i < value->items.size(); ++i) {
        const Node& one = value->items[i];
        if (one.is(Node::Kind::table))
            read_table(fmt::format("{}[{}]", path, i), one, [&](Fields& nested) { item(nested, i); });
        else
            wrong_kind(key.name, one, "a list of tables");
    }
}

}  // namespace unravel::sim
