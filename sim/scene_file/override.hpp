#pragma once

#include "sim/scene_file/document.hpp"

namespace unravel::sim {

/// Puts the value of the option "key=value" (the n-th, from 1) into the document, making tables on the way
/// where they are absent. What can't be done is added to the problems, located in the option. Whether the
/// key is known and the value fits is for the reader to say, as for the file.
void apply_override(Node& root, const std::string& text, int option, std::vector<SceneProblem>& problems);

}  // namespace unravel::sim
