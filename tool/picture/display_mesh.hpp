#pragma once

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A cloth's grid as triangles. A tube's seam column is doubled, so that uv runs on to the full circumference
/// there. A picture spans it once. `level`: of subdivision; the finer grid's points then stand at `first` in
/// DrawFrame::positions.
ClothMesh grid_mesh(const ClothPatch& patch, int level, std::size_t first);

/// A mesh as triangles. A vertex with several texture coordinates becomes a display vertex for each. A
/// picture lies where the file's texture coordinates say; where there are none it spans the cloth once, seen
/// along its thinnest axis.
ClothMesh face_mesh(const ClothPatch& patch);

}  // namespace unravel::tool
