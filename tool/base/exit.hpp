#pragma once

#include <stdexcept>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Exit codes, each of its own kind.
enum Exit : int {
    exit_done = 0,
    exit_usage = 2,
    exit_scene = 3,
    exit_no_renderer = 4,
    exit_simulation = 5,
    exit_output = 6,
    exit_signal = 128,  ///< and the number of the signal that stopped it: 130 for Ctrl-C
};

/// A command line that contradicts itself or names what does not exist. Exit code 2.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace unravel::tool
