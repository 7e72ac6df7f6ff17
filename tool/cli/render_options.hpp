#pragma once

#include "tool/base/names.hpp"
#include "tool/base/options.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// Reads the options that concern pictures, and applies --size to the scene. Throws UsageError.
ClipOptions clip_options_of(const Options& options, Scene& scene);

}  // namespace unravel::tool
