#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "sim/model/surface.hpp"
#include "sim/run/frame_record.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A cached run's geometry on its way into other programs. World: metres, right-handed, y up, as everywhere
/// here. Frames are read one at a time, so that memory does not grow with the clip.
struct ExportSource {
    const ClothModel& model;
    std::vector<ClothSurface> surfaces;  ///< (cloths)
    int first = 0, last = 0;             ///< frames
    Rate fps;
    std::function<FrameRecord(int frame)> read;  ///< throws InputError
    std::function<bool(int frame)> done;         ///< after each frame; false: stop, nothing is kept
    int frames() const { return last - first + 1; }
};

/// What was written, in order; empty where it was stopped.
using Written = std::vector<std::filesystem::path>;

/// frame_0000.obj …: every cloth an object of each, with texture coordinates, smooth normals and seams.
/// Positions have the digits that read back to the same doubles.
Written export_obj(const ExportSource& source, const std::filesystem::path& folder);

/// frame_0000.ply …, binary: positions as doubles, normals, and the colours of the component view (`colors`
/// is called for every frame from 0 on, in order), faces as they are.
Written export_ply(const ExportSource& source, const std::filesystem::path& folder,
                   const std::function<std::vector<Rgb>(const FrameRecord&)>& colors);

/// NAME.obj and NAME.pc2 (or NAME.mdd) for every cloth: its first frame as a mesh, and a point cache that
/// moves it. Positions are rounded to floats once.
Written export_point_cache(const ExportSource& source, const std::filesystem::path& folder, bool mdd);

/// NAME.glb, binary glTF 2.0: every cloth a mesh with one morph target per frame and an animation that is at
/// the frame's own target at the frame's time. `name` of the file.
Written export_glb(const ExportSource& source, const std::filesystem::path& folder, const std::string& name);

/// A cloth's part of a state. [m]
std::span<const Vec3> positions_of(const ClothPatch& patch, const FrameRecord& record);

/// Unit normals of a surface, weighted by area; (0, 1, 0) where there is none. (vertices)
std::vector<Vec3> surface_normals(const ClothSurface& surface, std::span<const Vec3> x);

/// A name as that of a file: letters, digits, '-', '_' and '.'; others become '_'.
std::string file_name(const std::string& name);

/// The cloths' names as those of files, no two the same: what is taken gets "_2", "_3", … (cloths)
std::vector<std::string> file_names(const ClothModel& model);

/// One cloth as the lines of an OBJ file, its object called `name`, after `vertices` and `uvs` that stand in
/// the file already.
std::string obj_text(const std::string& name, const ClothPatch& patch, const ClothSurface& surface,
                     std::span<const Vec3> x, std::size_t vertices, std::size_t uvs);

}  // namespace unravel::tool
