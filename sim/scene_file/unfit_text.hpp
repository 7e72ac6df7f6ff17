#pragma once

#include <optional>
#include <string_view>

#include "sim/scene_file/load.hpp"

namespace unravel::sim {

/// The first thing in a TOML text that the library (toml++ 3.3) is not to be given; empty if there is none.
///  - Keys of very many parts: it makes a table for each and frees them by recursion, down to the end of the
///    stack.
///  - Characters beyond ASCII outside of texts and comments, and texts in three quotes: both can lead it to a
///    place that its authors hold unreachable (its issues 190 and 295). TOML has no use for the former and a
///    scene none for the latter.
std::optional<SceneProblem> unfit_text(std::string_view text);

}  // namespace unravel::sim
