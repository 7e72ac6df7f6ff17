#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

namespace unravel {

inline bool is_type(const nlohmann::json& value, const std::string& type) {
    if (type == "number") return value.is_number();
    if (type == "integer") return value.is_number_integer();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "array") return value.is_array();
    return type == "object" && value.is_object();
}

/// `type` as a schema has it: one, or a list of them.
inline bool is_of(const nlohmann::json& value, const nlohmann::json& type) {
    if (!type.is_array()) return is_type(value, type);
    return std::any_of(type.begin(), type.end(),
                       [&](const nlohmann::json& one) { return is_type(value, one); });
}

/// The part of JSON schema that ours uses.
inline bool valid(const nlohmann::json& value, const nlohmann::json& schema) {
    const auto fits = [&](const nlohmann::json& form) { return valid(value, form); };
    if (schema.contains("anyOf") && std::none_of(schema["anyOf"].begin(), schema["anyOf"].end(), fits))
        return false;
    if (schema.contains("oneOf") && std::count_if(schema["oneOf"].begin(), schema["oneOf"].end(), fits) != 1)
        return false;
    if (schema.contains("type") && !is_of(value, schema["type"])) return false;
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
        return false;
    if (schema.contains("minimum") && value < schema["minimum"]) return false;
    if (schema.contains("exclusiveMinimum") && value <= schema["exclusiveMinimum"]) return false;
    if (schema.contains("maximum") && value > schema["maximum"]) return false;
    if (schema.contains("minItems") && value.size() < schema["minItems"]) return false;
    if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return false;
    if (schema.contains("minLength") && value.get<std::string>().size() < schema["minLength"]) return false;
    if (schema.contains("pattern") &&
        !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())))
        return false;
    if (schema.contains("required")) {
        for (const nlohmann::json& key : schema["required"])
            if (!value.contains(key.get<std::string>())) return false;
    }
    if (schema.contains("items")) {
        for (const nlohmann::json& item : value)
            if (!valid(item, schema["items"])) return false;
    }
    if (schema.contains("properties")) {
        for (const auto& [key, inner] : value.items())
            if (!schema["properties"].contains(key) || !valid(inner, schema["properties"][key])) return false;
    }
    if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
        for (const auto& [key, inner] : value.items())
            if (!valid(inner, schema["additionalProperties"])) return false;
    }
    return true;
}

}  // namespace unravel
