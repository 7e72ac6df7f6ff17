#pragma once

#include "tool/base/names.hpp"

namespace unravel::tool {

/// From construction on, INT, TERM and HUP ask for a stop instead of ending the program; a second one of them
/// ends it. Writing to a closed pipe is an error, not a signal.
class InterruptWatch {
public:
    InterruptWatch();
    static bool requested();
    /// Which signal asked, 0 if none.
    static int signal();
};

}  // namespace unravel::tool
