#pragma once

#include "tool/base/names.hpp"

namespace unravel::tool {

/// The tool's version, from CMakeLists.txt.
const char* version();

}  // namespace unravel::tool
