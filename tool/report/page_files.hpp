#pragma once

#include <string_view>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// A file of tool/report/ or of the chart library by its name, as it was when the tool was built; empty:
/// there is no such file.
std::string_view page_file(std::string_view name);

}  // namespace unravel::tool
