#pragma once

#include "sim/scene/scene.hpp"
#include "tool/base/options.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// Where `render` puts its pictures. A run's own folder holds the whole clip as its scene has it and nothing
/// else; a part of it, or pictures that the command line makes different (size, look, sampling), go to
/// renders/NAME within it, NAME telling what was asked for. With -o, where that says.
///   scene   with what the command line changes
RunFolder place_of_render(const Options& options, const RunFolder& run, const Scene& scene,
                          const ClipOptions& clip);

}  // namespace unravel::tool
