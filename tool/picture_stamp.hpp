#pragma once

#include <string>

#include "sim/scene/scene.hpp"
#include "tool/clip.hpp"
#include "tool/run_folder.hpp"

namespace unravel {

/// All that a picture depends on besides the simulated frame: cameras, look, size, sampling and renderer. Two
/// runs with equal stamps draw the same bytes.
std::string picture_stamp(const Scene& scene, const ClipOptions& options, const std::string& renderer);

/// Makes the folder's pictures of a view those of a stamp. True: what lies there was drawn with this very
/// stamp and may be taken over. Otherwise, and where `whole_clip` is to be drawn, old pictures are removed
/// and the stamp is put there; where only a part of the clip is, old pictures stay but will never be taken
/// over. Throws OutputError.
bool claim_pictures(const RunFolder& folder, const std::string& view, const std::string& stamp,
                    bool whole_clip);

}  // namespace unravel
