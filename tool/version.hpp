#pragma once

namespace unravel {

/// The tool's version, from CMakeLists.txt.
const char* version();

}  // namespace unravel
