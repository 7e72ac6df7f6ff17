#pragma once

#include "base/stop.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// From construction on, INT, TERM and HUP ask for a stop instead of ending the program; a second one of them
/// ends it at once. A signal that the caller has told the program to ignore (nohup, a shell's `&`) stays
/// ignored. Writing to a closed pipe is an error, not a signal.
class InterruptWatch {
public:
    InterruptWatch();
    static bool requested();
    /// For long loops that know no more than that they may be asked to stop.
    static StopFlag flag();
    /// 128 and the number of the signal that asked, as a shell tells of a program that one has ended.
    static int exit_code();
};

}  // namespace unravel::tool
