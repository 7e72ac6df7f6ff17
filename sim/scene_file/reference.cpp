#include "sim/scene_file/reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <map>

#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

namespace {

struct Section {
    std::string path;  ///< "cloth.material"
    std::string title, note, rows;
};

std::string quoted(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words)
        text += fmt::format("{}`\"{}\"`", text.empty() ? "" : ", ", word);
    return text;
}

std::string range_text(double low, double high, bool above_low, std::string_view unit) {
    const std::string space = unit.empty() ? "" : " ";
    return above_low ? fmt::format("above {:g}, to {:g}{}{}", low, high, space, unit)
                     : fmt::format("{:g} to {:g}{}{}", low, high, space, unit);
}

std::string range_text(const Bounds& b) {
    return range_text(b.low, b.high, b.above_low, b.unit);
}

/// Collects the sections of a table and of those below it. `inline_` tables stand as { … } in their key.
class ReferenceFields : public Fields {
public:
    ReferenceFields(std::vector<Section>& sections, std::string path, std::string title, std::string note)
        : sections_(sections), index_(sections.size()), path_(std::move(path)) {
        sections_.push_back({path_, std::move(title), std::move(note), ""});
    }

    void exactly_one(std::initializer_list<std::string_view> keys) override {
        sections_[index_].note += fmt::format(" Exactly one of `{}`.", fmt::join(keys, "`, `"));
    }
    void flag(const Key& key, bool& value) override { row(key, value ? "true" : "false", "true or false"); }
    void integer(const Key& key, int& value, int low, int high) override {
        row(key, fmt::format("{}", value), fmt::format("{} to {}", low, high));
    }
    void rate(const Key& key, Rate& value, int low, int high) override {
        row(key, rate_text(value), fmt::format("{} to {}", low, high));
    }
    void integers(const Key& key, std::span<int> values, int low, int high) override {
        row(key, fmt::format("[{}]", fmt::join(values, ", ")),
            fmt::format("{} of {} to {}", values.size(), low, high));
    }
    void seed(const Key& key, std::uint32_t& value) override {
        row(key, fmt::format("{}", value), "0 to 4294967295");
    }
    void number(const Key& key, double& value, const Bounds& bounds) override {
        row(key, fmt::format("{:g}", value), range_text(bounds));
    }
    void optional_number(const Key& key, std::optional<double>&, const Bounds& bounds) override {
        row(key, "absent", range_text(bounds));
    }
    void numbers(const Key& key, std::span<double> values, const Bounds& bounds) override {
        row(key, fmt::format("[{:g}]", fmt::join(values, ", ")),
            fmt::format("{} of {}", values.size(), range_text(bounds)));
    }
    void number_or_pair(const Key& key, std::array<double, 2>& values, const Bounds& bounds) override {
        row(key, fmt::format("{:g}", values[0]), fmt::format("1 or 2 of {}", range_text(bounds)));
    }
    void fraction(const Key& key, double& value, const Bounds& bounds) override {
        row(key, fmt::format("{:.4g}", value), range_text(bounds));
    }
    bool number_or_table(const Key& key, double& value, const Bounds& bounds,
                         const std::function<void(Fields&)>& describe) override {
        row(key, fmt::format("{:g}", value), fmt::format("{}, or a table", range_text(bounds)));
        nest(key, path_ + "." + std::string(key.name), "", describe);
        return false;
    }
    void text(const Key& key, std::string& value, TextKind kind) override {
        constexpr std::string_view kinds[] = {"1 to 64 characters", "`\"#rrggbb\"`", "file name"};
        row(key, value.empty() ? "absent" : fmt::format("\"{}\"", value), kinds[static_cast<int>(kind)]);
    }
    void texts(const Key& key, std::vector<std::string>&, TextKind) override {
        row(key, "absent", "file name, or a list of them");
    }
    void word(const Key& key, std::string&, std::span<const std::string_view> words) override {
        row(key, "absent", quoted(words));
    }
    void words(const Key& key, std::vector<std::string>&, std::span<const std::string_view> words) override {
        row(key, "absent", quoted(words) + ", or a list of them");
    }
    void table(const Key& key, const std::function<void(Fields&)>& describe) override {
        row(key, "absent", "table");
        nest(key, path_.empty() ? std::string(key.name) : path_ + "." + std::string(key.name), "", describe);
    }

protected:
    bool creates(const Key&) override { return true; }
    void choose(const Key& key, int& index, std::span<const std::string_view> words) override {
        row(key, fmt::format("\"{}\"", words[static_cast<std::size_t>(index)]), quoted(words));
    }
    void items(const Key& key, std::size_t, const std::function<void(std::size_t)>& resize,
               const std::function<void(Fields&, std::size_t)>& item, ListForm layout) override {
        const bool tables = layout == ListForm::tables;
        row(key, "absent", tables ? "table, or several" : "list of tables");
        resize(1);
        nest(key, path_.empty() ? std::string(key.name) : path_ + "." + std::string(key.name),
             tables ? "list" : "inline", [&](Fields& nested) { item(nested, 0); });
        resize(0);
    }

private:
    void row(const Key& key, std::string_view initial, std::string_view allowed) {
        sections_[index_].rows +=
            fmt::format("| `{}` | {} | {} | {} |\n", key.name,
                        key.required ? std::string_view("required") : initial, allowed, key.doc);
    }

    void nest(const Key& key, const std::string& path, std::string_view kind,
              const std::function<void(Fields&)>& describe) {
        std::string title = fmt::format("`[{}]`", path);
        if (kind == "list") title = fmt::format("`[[{}]]`", path);
        if (kind == "inline") title = fmt::format("`{}`: a list of `{{ … }}`", path);
        std::string note(key.doc);
        if (!note.empty()) note[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(note[0])));
        ReferenceFields nested(sections_, path, std::move(title), note + ".");
        describe(nested);
    }

    std::vector<Section>& sections_;
    std::size_t index_;
    std::string path_;
};

}  // namespace

std::string scene_reference() {
    std::vector<Section> sections;
    Scene scene;
    ReferenceFields fields(sections, "", "The top of the file", "");
    describe(fields, scene);

    std::string text;
    std::map<std::string, std::string> known;  // rows, and where they were first
    for (const Section& section : sections) {
        text += fmt::format("### {}\n\n{}", section.title, section.note);
        const auto [first, fresh] = known.emplace(section.rows, section.path);
        if (fresh)
            text += fmt::format("{}| key | default | values | meaning |\n|---|---|---|---|\n{}\n",
                                section.note.empty() ? "" : "\n\n", section.rows);
        else
            text += fmt::format(" The keys are those of `{}`.\n\n", first->second);
    }
    return text;
}

}  // namespace unravel::sim
