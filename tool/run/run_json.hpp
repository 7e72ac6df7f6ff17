#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/picture/clip.hpp"
#include "tool/run/run_source.hpp"

namespace unravel::tool {

/// Frames per second as files for programs have it: a whole number, or a text such as "30000/1001".
nlohmann::ordered_json rate_json(const Rate& rate);

/// The content of run.json. `status` is "complete", "interrupted" or "failed"; `clip` is null where nothing
/// was drawn.
nlohmann::ordered_json run_json(const Scene& scene, const Simulation& simulation, const RunSource& source,
                                int threads, const std::string& status, const ClipReport* clip);

}  // namespace unravel::tool
