#pragma once

#include <string>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// This machine's name, "unknown" where it has none.
std::string host_name();

/// The model of its processor as the system tells it, without commas: what times may be compared by.
std::string processor_name();

/// Memory that the program can still take.
struct MemoryRoom {
    double bytes = 0;
    std::string limit;  ///< what sets the bound: "ulimit -v", "this container", "this machine"
    /// "ulimit -v leaves 512 MB"
    std::string told() const;
};

/// The least of what the machine has available, its control group allows and `ulimit -v` leaves.
MemoryRoom memory_room();

/// What bounds the number of threads, in words.
std::string thread_limit();

}  // namespace unravel::tool
