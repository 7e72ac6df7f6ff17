#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/inspect/figures.hpp"

namespace unravel::tool {

/// The inspector's page, whole in itself. `views`: pictures of the step, may be none, then `no_views` says
/// why. `asked`: numbers of a particle or spring by heading.
std::string inspect_page(const InspectedStep& step, const std::string& scene_name,
                         const std::vector<Image>& views, const std::string& no_views,
                         const std::vector<Figure>& figures,
                         const std::vector<std::pair<std::string, nlohmann::ordered_json>>& asked);

}  // namespace unravel::tool
