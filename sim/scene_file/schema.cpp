#include "sim/scene_file/schema.hpp"

#include <nlohmann/json.hpp>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

namespace {

using nlohmann::json;

json range(const Bounds& bounds) {
    return {{"type", "number"},
            {bounds.above_low ? "exclusiveMinimum" : "minimum", bounds.low},
            {"maximum", bounds.high}};
}

json list_of(json item, std::size_t count) {
    return {{"type", "array"}, {"items", std::move(item)}, {"minItems", count}, {"maxItems", count}};
}

json one_of_words(std::span<const std::string_view> words) {
    json list = json::array();
    for (const std::string_view word : words) list.push_back(word);
    return {{"type", "string"}, {"enum", std::move(list)}};
}

/// Builds the schema of one table.
class SchemaFields : public Fields {
public:
    json table_schema() && {
        json out{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties_)}};
        if (!required_.empty()) out["required"] = std::move(required_);
        if (!alternatives_.empty()) out["oneOf"] = std::move(alternatives_);
        return out;
    }

    void exactly_one(std::initializer_list<std::string_view> keys) override {
        for (const std::string_view key : keys) alternatives_.push_back({{"required", {key}}});
    }
    void flag(const Key& key, bool& value) override { put(key, {{"type", "boolean"}}, value); }
    void integer(const Key& key, int& value, int low, int high) override {
        put(key, {{"type", "integer"}, {"minimum", low}, {"maximum", high}}, value);
    }
    void rate(const Key& key, Rate& value, int low, int high) override {
        put(key,
            {{"anyOf",
              {{{"type", "integer"}, {"minimum", low}, {"maximum", high}},
               {{"type", "string"}, {"pattern", "^[1-9][0-9]*/[1-9][0-9]*$"}}}}},
            value.num);
    }
    void integers(const Key& key, std::span<int> values, int low, int high) override {
        json item{{"type", "integer"}, {"minimum", low}, {"maximum", high}};
        put(key, list_of(std::move(item), values.size()), values);
    }
    void seed(const Key& key, std::uint32_t& value) override {
        put(key, {{"type", "integer"}, {"minimum", 0}, {"maximum", 0xFFFFFFFF}}, value);
    }
    void number(const Key& key, double& value, const Bounds& bounds) override {
        put(key, range(bounds), value);
    }
    void optional_number(const Key& key, std::optional<double>&, const Bounds& bounds) override {
        put(key, range(bounds), nullptr);
    }
    void numbers(const Key& key, std::span<double> values, const Bounds& bounds) override {
        put(key, list_of(range(bounds), values.size()), values);
    }
    void number_or_pair(const Key& key, std::array<double, 2>& values, const Bounds& bounds) override {
        put(key, {{"anyOf", {range(bounds), list_of(range(bounds), 2)}}}, values);
    }
    void fraction(const Key& key, double& value, const Bounds& bounds) override {
        put(key, {{"anyOf", {range(bounds), {{"type", "string"}, {"pattern", "^[1-9][0-9]*/[1-9][0-9]*$"}}}}},
            value);
    }
    bool number_or_table(const Key& key, double&, const Bounds& bounds,
                         const std::function<void(Fields&)>& describe) override {
        put(key, {{"anyOf", {range(bounds), nested(describe)}}}, nullptr);
        return false;
    }
    void text(const Key& key, std::string& value, TextKind kind) override {
        json schema{{"type", "string"}, {"minLength", 1}};
        if (kind == TextKind::color) schema["pattern"] = "^#[0-9a-fA-F]{6}$";
        put(key, std::move(schema), value.empty() ? json() : json(value));
    }
    void texts(const Key& key, std::vector<std::string>&, TextKind) override {
        const json one{{"type", "string"}, {"minLength", 1}};
        json list{{"type", "array"}, {"items", one}, {"minItems", 1}, {"maxItems", max_includes}};
        put(key, {{"anyOf", {one, std::move(list)}}}, nullptr);
    }
    void word(const Key& key, std::string&, std::span<const std::string_view> words) override {
        put(key, one_of_words(words), nullptr);
    }
    void words(const Key& key, std::vector<std::string>&, std::span<const std::string_view> words) override {
        json list{
            {"type", "array"}, {"items", one_of_words(words)}, {"minItems", 1}, {"maxItems", words.size()}};
        put(key, {{"anyOf", {one_of_words(words), std::move(list)}}}, nullptr);
    }
    void table(const Key& key, const std::function<void(Fields&)>& describe) override {
        put(key, nested(describe), nullptr);
    }

protected:
    bool creates(const Key&) override { return true; }
    void choose(const Key& key, int& index, std::span<const std::string_view> words) override {
        put(key, one_of_words(words), words[static_cast<std::size_t>(index)]);
    }
    void items(const Key& key, std::size_t, const std::function<void(std::size_t)>& resize,
               const std::function<void(Fields&, std::size_t)>& item, ListForm layout) override {
        resize(1);
        const json one = nested([&](Fields& fields) { item(fields, 0); });
        resize(0);
        json list{{"type", "array"}, {"items", one}, {"maxItems", max_list}};
        if (key.required) list["minItems"] = 1;
        put(key, layout == ListForm::tables ? json{{"anyOf", {one, std::move(list)}}} : std::move(list),
            nullptr);
    }

private:
    static json nested(const std::function<void(Fields&)>& describe) {
        SchemaFields fields;
        describe(fields);
        return std::move(fields).table_schema();
    }

    void put(const Key& key, json schema, const json& initial) {
        schema["description"] = key.doc;
        if (key.required)
            required_.push_back(key.name);
        else if (!initial.is_null())
            schema["default"] = initial;
        properties_[std::string(key.name)] = std::move(schema);
    }

    json properties_ = json::object(), required_ = json::array(), alternatives_ = json::array();
};

/// Walks the schema of a table; `header` is its path with dots, `list` whether it may be one of several.
void collect(const json& schema, const std::string& header, bool list,
             std::map<std::string, std::vector<std::string>>& found) {
    if (schema.contains("anyOf")) {
        const json& forms = schema["anyOf"];
        const bool many =
            forms.back().value("type", "") == "array" && forms.back()["items"].contains("properties");
        for (const json& form : forms) {
            if (form.contains("properties")) collect(form, header, many, found);
        }
    }
    if (schema.contains("items") && schema["items"].contains("properties"))
        collect(schema["items"], header, true, found);
    if (!schema.contains("properties")) return;
    std::string shown = "the top of the file";
    if (!header.empty()) shown = list ? "[[" + header + "]]" : "[" + header + "]";
    for (const auto& [name, property] : schema["properties"].items()) {
        found[name].push_back(shown);
        collect(property, header.empty() ? name : header + "." + name, false, found);
    }
}

}  // namespace

json scene_schema() {
    SchemaFields fields;
    Scene scene;
    describe(fields, scene);
    json schema = std::move(fields).table_schema();
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    schema["title"] = "Unravel scene";
    return schema;
}

std::map<std::string, std::vector<std::string>> tables_of_keys() {
    std::map<std::string, std::vector<std::string>> found;
    collect(scene_schema(), "", false, found);
    return found;
}

}  // namespace unravel::sim
