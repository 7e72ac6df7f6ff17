#pragma once

#include <filesystem>

#include "render/gl_context.hpp"
#include "tool/base/names.hpp"
#include "tool/study/stability/hard_case.hpp"

namespace unravel::tool {

/// Draws where a hard case ended, textured; cloth too small in the picture to be seen is ringed. False where
/// there is no state to be drawn: the scene was refused. Throws what drawing and writing throw.
bool draw_hard_case(const GlContext& context, const HardOutcome& outcome, const std::filesystem::path& file);

}  // namespace unravel::tool
