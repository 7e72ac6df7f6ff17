#include "sim/scene_file/include.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/check.hpp"

namespace unravel::sim {

namespace {

void move_to_file(Node& node, int file) {
    node.place.file = file;
    for (Node& item : node.items) move_to_file(item, file);
    for (Entry& entry : node.entries) {
        entry.place.file = file;
        move_to_file(entry.value, file);
    }
}

bool is_tables(const Node& node) {
    return node.is(Node::Kind::table) ||
           (node.is(Node::Kind::list) && !node.items.empty() && node.items.front().is(Node::Kind::table));
}

// One table where several may stand is a list of one.
void make_list(Node& node) {
    if (node.is(Node::Kind::list)) return;
    Node list;
    list.kind = Node::Kind::list;
    list.place = node.place;
    list.items.push_back(std::move(node));
    node = std::move(list);
}

// What `under` has and `over` has not.
void join(Node under, Node& over, bool top) {
    for (Entry& entry : under.entries) {
        Entry* own = over.find(entry.key);
        if (!own) {
            over.entries.push_back(std::move(entry));
        } else if (entry.value.is(Node::Kind::table) && own->value.is(Node::Kind::table)) {
            join(std::move(entry.value), own->value, false);
        } else if (top && is_tables(entry.value) && is_tables(own->value)) {
            make_list(entry.value);
            make_list(own->value);
            std::ranges::move(own->value.items, std::back_inserter(entry.value.items));
            own->value.items = std::move(entry.value.items);
        }
    }
}

class Includer {
public:
    Includer(std::filesystem::path home, std::vector<IncludedFile>& included,
             std::vector<SceneProblem>& problems)
        : home_(std::move(home)), included_(included), problems_(problems) {}

    // `chain`: the files on the way to this one.
    void take_over(Node& root, std::vector<std::filesystem::path> chain) {
        const Entry* entry = root.find("include");
        if (!entry) return;
        // A wrong kind is reported by who reads the document.
        std::vector<Node> names{entry->value};
        if (entry->value.is(Node::Kind::list)) names = entry->value.items;
        Node under;
        for (const Node& name : names) {
            if (!name.is(Node::Kind::text)) continue;
            Node one;
            if (read(name, chain, one)) {
                join(std::move(under), one, true);
                under = std::move(one);
            }
        }
        join(std::move(under), root, true);
    }

private:
    bool read(const Node& name, std::vector<std::filesystem::path> chain, Node& out) {
        const auto refuse = [&](std::string what, std::string hint) {
            problems_.push_back({name.place, std::move(what), std::move(hint)});
            return false;
        };
        if (included_.size() >= max_includes)
            return refuse("too many files are included", fmt::format("at most {}", max_includes));
        const ContainedFile found = contained_file(home_, name.text, "included file");
        if (!found.what.empty()) return refuse(found.what, found.hint);
        if (std::ranges::find(chain, found.file) != chain.end())
            return refuse(fmt::format("\"{}\" includes itself", name.text), "leave it out");
        std::ifstream stream(found.file, std::ios::binary);
        std::string text(max_scene_bytes + 1, '\0');
        stream.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(stream.gcount()));
        if (text.size() > max_scene_bytes || stream.bad())
            return refuse(fmt::format("\"{}\" can't be read, or is too large", name.text),
                          fmt::format("at most {} MiB are", max_scene_bytes >> 20));
        included_.push_back({(home_ / name.text).lexically_normal().string(), std::move(text)});
        const int file = static_cast<int>(included_.size());
        const std::size_t before = problems_.size();
        const bool parsed = parse_document(included_.back().text, out, problems_);
        for (std::size_t k = before; k < problems_.size(); ++k) problems_[k].place.file = file;
        if (!parsed) return false;
        move_to_file(out, file);
        chain.push_back(found.file);
        take_over(out, std::move(chain));
        // What it includes and where its files are is its own affair.
        std::erase_if(out.entries,
                      [](const Entry& entry) { return entry.key == "include" || entry.key == "root"; });
        return true;
    }

    std::filesystem::path home_;
    std::vector<IncludedFile>& included_;
    std::vector<SceneProblem>& problems_;
};

}  // namespace

void take_over_included(Node& root, const std::string& scene, const std::filesystem::path& folder,
                        std::vector<IncludedFile>& included, std::vector<SceneProblem>& problems) {
    if (!root.find("include")) return;
    std::filesystem::path home = folder.empty() ? std::filesystem::path(".") : folder;
    const Entry* around = root.find("root");
    if (around && around->value.is(Node::Kind::text)) home /= around->value.text;
    std::error_code error;
    Includer(home, included, problems).take_over(root, {std::filesystem::weakly_canonical(scene, error)});
}

}  // namespace unravel::sim
