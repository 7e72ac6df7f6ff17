#pragma once

#include <string>

namespace unravel::sim {

/// Every table and key of the scene file with default, bounds, unit and meaning, as Markdown tables in the
/// order in which the file is read. Made by the same descriptions that read the file.
std::string scene_reference();

}  // namespace unravel::sim
