#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace unravel::sim {

/// JSON schema (draft 2020-12) of the scene file, for editors: keys, types, bounds, defaults, meaning. Made
/// by the same descriptions that read the file. What concerns several keys at once is load_scene()'s alone.
nlohmann::json scene_schema();

/// For each key the headers under which it may stand: "[solver]", "[[cloth.pin]]", "the top of the file".
std::map<std::string, std::vector<std::string>> tables_of_keys();

}  // namespace unravel::sim
