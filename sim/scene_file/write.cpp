#include <fmt/core.h>

#include <cmath>
#include <type_traits>

#include "sim/scene_file/describe.hpp"
#include "sim/scene_file/load.hpp"

namespace unravel::sim {

namespace {

std::string toml_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

// fmt's {} is the shortest text that reads back to the same value; but "-0" would be TOML's integer, which
// knows no sign of zero.
std::string number_text(double value) {
    return value == 0 && std::signbit(value) ? "-0.0" : fmt::format("{}", value);
}

/// Writes one table: its own lines first, then the tables in it, as TOML asks.
class Writer : public Fields {
public:
    explicit Writer(std::string path) : path_(std::move(path)) {}

    bool writing() const override { return true; }

    std::string lines() const { return fmt::format("{}{}{}", join("\n"), own_.empty() ? "" : "\n", nested_); }
    std::string inline_table() const { return fmt::format("{{{}}}", join(", ")); }

    void flag(const Key& key, bool& value) override { put(key, value ? "true" : "false"); }
    void integer(const Key& key, int& value, int, int) override { put(key, fmt::format("{}", value)); }
    void rate(const Key& key, Rate& value, int, int) override {
        put(key, value.whole() ? rate_text(value) : toml_text(rate_text(value)));
    }
    void integers(const Key& key, std::span<int> values, int, int) override { put(key, list_of(values)); }
    void seed(const Key& key, std::uint32_t& value) override { put(key, fmt::format("{}", value)); }
    void number(const Key& key, double& value, const Bounds&) override { put(key, number_text(value)); }
    void optional_number(const Key& key, std::optional<double>& value, const Bounds&) override {
        if (value) put(key, number_text(*value));
    }
    void numbers(const Key& key, std::span<double> values, const Bounds&) override {
        put(key, list_of(values));
    }
    void number_or_pair(const Key& key, std::array<double, 2>& values, const Bounds&) override {
        put(key, list_of(std::span<double>(values)));
    }
    void fraction(const Key& key, double& value, const Bounds& bounds) override {
        number(key, value, bounds);
    }
    bool number_or_table(const Key& key, double&, const Bounds&,
                         const std::function<void(Fields&)>& describe) override {
        Writer writer("");
        describe(writer);
        put(key, writer.inline_table());
        return false;
    }
    void text(const Key& key, std::string& value, TextKind) override {
        if (!value.empty()) put(key, toml_text(value));
    }
    void texts(const Key& key, std::vector<std::string>& values, TextKind) override {
        std::string list;
        for (const std::string& value : values) list += (list.empty() ? "" : ", ") + toml_text(value);
        if (!values.empty()) put(key, "[" + list + "]");
    }
    void word(const Key& key, std::string& value, std::span<const std::string_view>) override {
        if (!value.empty()) put(key, toml_text(value));
    }
    void words(const Key& key, std::vector<std::string>& values, std::span<const std::string_view>) override {
        if (values.size() == 1) put(key, toml_text(values[0]));
    }
    void table(const Key& key, const std::function<void(Fields&)>& describe) override {
        if (!key.applies) return;
        Writer writer(path_of(key));
        describe(writer);
        nested_ += fmt::format("\n[{}]\n{}", path_of(key), writer.lines());
    }

protected:
    bool creates(const Key&) override { return false; }
    void choose(const Key& key, int& index, std::span<const std::string_view> words) override {
        put(key, toml_text(words[static_cast<std::size_t>(index)]));
    }
    void items(const Key& key, std::size_t count, const std::function<void(std::size_t)>&,
               const std::function<void(Fields&, std::size_t)>& item, ListForm layout) override {
        if (count == 0) return;
        std::string inline_list = "[";
        for (std::size_t i = 0; i < count; ++i) {
            Writer writer(path_of(key));
            item(writer, i);
            if (layout == ListForm::tables)
                nested_ += fmt::format("\n[[{}]]\n{}", path_of(key), writer.lines());
            else
                inline_list += fmt::format("{}\n    {}", i ? "," : "", writer.inline_table());
        }
        if (layout == ListForm::inline_tables) put(key, inline_list + "\n]");
    }

private:
    template <class T>
    static std::string list_of(std::span<T> values) {
        std::string out = "[";
        for (std::size_t i = 0; i < values.size(); ++i) {
            out += i ? ", " : "";
            if constexpr (std::is_same_v<T, double>)
                out += number_text(values[i]);
            else
                out += fmt::format("{}", values[i]);
        }
        return out + "]";
    }
    std::string join(std::string_view between) const {
        std::string out;
        for (std::size_t i = 0; i < own_.size(); ++i) {
            if (i > 0) out += between;
            out += own_[i];
        }
        return out;
    }
    std::string path_of(const Key& key) const {
        return path_.empty() ? std::string(key.name) : fmt::format("{}.{}", path_, key.name);
    }
    void put(const Key& key, const std::string& value) {
        if (key.applies) own_.push_back(fmt::format("{} = {}", key.name, value));
    }

    std::string path_;
    std::vector<std::string> own_;
    std::string nested_;
};

}  // namespace

std::string scene_to_toml(const Scene& scene) {
    Writer writer("");
    Scene copy = scene;  // a description takes values that it may change; the writer changes none
    describe(writer, copy);
    return writer.lines();
}

}  // namespace unravel::sim
