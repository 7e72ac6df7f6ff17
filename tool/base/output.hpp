#pragma once

#include "tool/base/names.hpp"

namespace unravel::tool {

/// How much a command says, and how.
struct OutputOptions {
    bool quiet = false;  ///< errors only
    bool json = false;   ///< the result as JSON
    bool talks() const { return !quiet && !json; }
};

}  // namespace unravel::tool
