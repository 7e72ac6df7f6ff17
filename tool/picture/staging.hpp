#pragma once

#include <filesystem>

#include "render/draw_scene.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// "#rrggbb"; anything else throws std::invalid_argument (a checked scene holds nothing else).
Rgb parse_color(const std::string& text);

/// Light, background and ground of a scene's look. `textures`: the folder that its pictures are named
/// relative to; empty: none is read. Throws InputError where one can't be read.
void set_stage(const Look& look, const std::filesystem::path& textures, DrawScene& out);

/// What the look says of the surface of the scene's solid of this index. Likewise.
void set_surface(const Look& look, std::size_t solid, const std::filesystem::path& textures, SolidMesh& out);

}  // namespace unravel::tool
