#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/scene_file/diagnostics.hpp"
#include "sim/scene_file/document.hpp"

namespace unravel::sim {

/// Puts the tables of the files that `root` includes into it, and of those that they include. A key of the
/// one that includes replaces the same key of the included; tables are joined key by key; the lists of tables
/// at the top ([[cloth]], [[solid]], [[camera]]) one behind the other, the included first. Files lie in the
/// scene's folder, or in the root that it names; their texts are kept in `included`, to which places refer.
void take_over_included(Node& root, const std::string& scene, const std::filesystem::path& folder,
                        std::vector<IncludedFile>& included, std::vector<SceneProblem>& problems);

}  // namespace unravel::sim
