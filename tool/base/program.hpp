#pragma once

#include <filesystem>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// The file of this very program; "unravel" where the system does not tell.
std::filesystem::path program_file();

/// The scenes that ship: where they are installed, or else in the sources that it was built from.
std::filesystem::path shipped_scenes();

}  // namespace unravel::tool
