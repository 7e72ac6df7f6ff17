#pragma once

#include "render/draw_scene.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A solid as the renderer takes it, in its own frame and in the default colour; of a mesh that deforms, as
/// it is at t = 0.
SolidMesh drawn_solid(const Solid& solid);

}  // namespace unravel::tool
