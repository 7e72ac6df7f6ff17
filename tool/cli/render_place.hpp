#pragma once

#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/cli/picture_options.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// Where `render` puts its pictures unless -o says. A run's own folder holds the whole clip as its scene has
/// it and nothing else; a part of it, or pictures that the command line makes different (size, look,
/// sampling), go to renders/NAME within it, NAME telling what was asked for.
///   scene   of the run, with what the command line changes
RunFolder place_of_render(const PictureOptions& options, const std::vector<std::string>& overrides,
                          const RunFolder& run, const Scene& scene, const ClipOptions& clip);

}  // namespace unravel::tool
