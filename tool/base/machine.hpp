#pragma once

#include <string>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// This machine's name, "unknown" where it has none.
std::string host_name();

/// The model of its processor as the system tells it, without commas: what times may be compared by.
std::string processor_name();

}  // namespace unravel::tool
