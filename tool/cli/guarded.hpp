#pragma once

#include <functional>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Runs a command, or a part of one, and turns what it throws into one message on standard error and one exit
/// code. Standard output that nobody could read is a failure too.
int guarded(const std::function<int()>& command);

}  // namespace unravel::tool
