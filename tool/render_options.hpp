#pragma once

#include "tool/clip.hpp"
#include "tool/names.hpp"
#include "tool/options.hpp"

namespace unravel::tool {

/// A command line that contradicts itself or names what does not exist. Exit code 2.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reads the options that concern pictures, and applies --size to the scene. Throws UsageError.
ClipOptions clip_options_of(const Options& options, Scene& scene);

}  // namespace unravel::tool
