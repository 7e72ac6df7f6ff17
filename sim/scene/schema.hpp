#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace unravel {

/// JSON schema (draft 2020-12) of the scene file, for editors: keys, types, bounds, defaults, meaning. Made
/// by the same descriptions that read the file. What concerns several keys at once is load_scene()'s alone.
nlohmann::json scene_schema();

/// The headers under which a key of this name may stand: "[solver]", "[[cloth.pin]]", "the top of the file".
std::vector<std::string> tables_with_key(std::string_view key);

}  // namespace unravel
