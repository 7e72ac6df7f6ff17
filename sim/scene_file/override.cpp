#include "sim/scene_file/override.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/diagnostics.hpp"

namespace unravel::sim {

namespace {

/// One part of "cloth[1].pin[0].release".
struct Step {
    std::string key;
    std::optional<std::size_t> index;
    SourcePlace place;
};

bool in_key(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
}

/// The parts of a path; empty where it is none.
std::vector<Step> parse_path(std::string_view path, int option) {
    std::vector<Step> steps;
    while (!path.empty() && path.back() == ' ') path.remove_suffix(1);
    std::size_t at = std::min(path.find_first_not_of(' '), path.size());
    while (at < path.size()) {
        Step step{{}, {}, {1, static_cast<int>(at) + 1, option}};
        while (at < path.size() && in_key(path[at])) step.key += path[at++];
        if (step.key.empty() || steps.size() >= max_key_parts) return {};
        if (at < path.size() && path[at] == '[') {
            std::size_t index = 0;
            const char* end = path.data() + path.size();
            const auto [rest, error] = std::from_chars(path.data() + at + 1, end, index);
            if (error != std::errc() || rest == end || *rest != ']') return {};
            step.index = index;
            at = static_cast<std::size_t>(rest - path.data()) + 1;
        }
        steps.push_back(std::move(step));
        if (at == path.size()) return steps;
        if (path[at++] != '.') return {};
    }
    return {};
}

/// TOML, or a bare word, which stands for itself: solver.integrator=implicit.
bool parse_option_value(std::string_view text, int option, int shift, Node& value) {
    if (text.find('\n') != std::string_view::npos) return false;
    const std::size_t blanks = std::min(text.find_first_not_of(" \t"), text.size());
    std::string_view word = text.substr(blanks);
    while (!word.empty() && (word.back() == ' ' || word.back() == '\t')) word.remove_suffix(1);
    if (word.empty()) return false;
    if (parse_value(text, option, shift, value)) return true;
    if (word.find_first_of("[]{}\"',=") != std::string_view::npos) return false;
    value.kind = Node::Kind::text;
    value.text = word;
    value.place = {1, shift + static_cast<int>(blanks) + 1, option};
    return true;
}

/// The node that the step leads to inside a table, or null with a problem added.
Node* descend(Node& table, const Step& step, bool last, std::vector<SceneProblem>& problems) {
    Entry* entry = table.find(step.key);
    const auto refuse = [&](std::string what, std::string hint) {
        problems.push_back({step.place, std::move(what), std::move(hint)});
        return nullptr;
    };
    if (!entry) {
        if (step.index.value_or(0) > 0)
            return refuse(fmt::format("the scene has no {}[{}]", step.key, *step.index), "count from 0");
        Node made;
        made.place = step.place;
        table.entries.push_back({step.key, step.place, std::move(made)});
        return &table.entries.back().value;
    }
    entry->place = step.place;
    Node& value = entry->value;
    if (step.index) {
        if (value.is(Node::Kind::table) && *step.index == 0) return &value;
        if (value.is(Node::Kind::list) && *step.index < value.items.size()) return &value.items[*step.index];
        const std::size_t count = value.is(Node::Kind::list) ? value.items.size() : 1;
        return refuse(fmt::format("there is no {}[{}]", step.key, *step.index),
                      fmt::format("the scene has {}, counted from 0", count));
    }
    const bool tables =
        value.is(Node::Kind::list) && !value.items.empty() && value.items[0].is(Node::Kind::table);
    if (last || !tables) return &value;
    if (value.items.size() == 1) return &value.items[0];
    return refuse(fmt::format("the scene has {} of '{}'", value.items.size(), step.key),
                  fmt::format("say which: {}[0] …", step.key));
}

}  // namespace

void apply_override(Node& root, const std::string& text, int option, std::vector<SceneProblem>& problems) {
    const auto refuse = [&](std::size_t at, std::string what, std::string hint) {
        problems.push_back({{1, static_cast<int>(at) + 1, option}, std::move(what), std::move(hint)});
    };
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        refuse(text.size(), "no '='", "write key=value, for example solver.step=0.005");
        return;
    }
    const std::vector<Step> steps = parse_path(std::string_view(text).substr(0, equals), option);
    if (steps.empty()) {
        refuse(0, "this is no key", "write a path such as solver.step or cloth[0].particles");
        return;
    }
    Node value;
    if (!parse_option_value(std::string_view(text).substr(equals + 1), option, static_cast<int>(equals) + 1,
                            value)) {
        refuse(equals + 1, "this is no value",
               "write a number, true, false, a word, \"a text\" or a list such as [51, 51]");
        return;
    }
    Node* node = &root;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!node->is(Node::Kind::table)) {
            refuse(static_cast<std::size_t>(steps[i].place.column) - 1,
                   fmt::format("'{}' is {} and has no '{}'", steps[i - 1].key, kind_name(node->kind),
                               steps[i].key),
                   "");
            return;
        }
        node = descend(*node, steps[i], i + 1 == steps.size(), problems);
        if (!node) return;
    }
    *node = std::move(value);
}

}  // namespace unravel::sim
