#pragma once

#include "tool/base/names.hpp"
#include "tool/base/options.hpp"

namespace unravel::tool {

/// `unravel bench [SCENE]`: measures and prints how fast the scene, hang by default, is simulated by size,
/// and leaves tables, plots and records in a folder.
int command_bench_speed(const Options& options);

}  // namespace unravel::tool
