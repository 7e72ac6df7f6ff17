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

/// What a cloth looks like in programs that know no weaves.
struct ExportLook {
    Rgb front{140, 64, 74};
    std::vector<std::uint8_t> texture = {};  ///< a PNG file's bytes, as they are; empty: none
};

/// A solid that stands or moves beside the cloths.
struct ExportSolid {
    std::string name;
    Rgb color;
    std::vector<Vec3f> positions;                         ///< (vertices) in its own frame [m]
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
    std::function<Eigen::Isometry3d(double t)> pose;      ///< own frame to world, at t [s]
    bool moves = false;                                   ///< the pose is not the same all the time
    std::function<void(double t, std::vector<Vec3>& out)> shape = {};  ///< positions, where it deforms [m]
};

struct ExportCamera {
    std::string name;
    double aspect = 1;  ///< width over height
    std::function<CameraView(double t)> view;
};

/// A cached run's geometry on its way into other programs. World: metres, right-handed, y up, as everywhere
/// here. Frames are read one at a time, so that memory does not grow with the clip.
struct ExportSource {
    const ClothModel& model;
    std::vector<ClothSurface> surfaces;  ///< (cloths)
    int first = 0, last = 0;             ///< frames
    Rate fps;
    std::function<FrameRecord(int frame)> read;  ///< throws InputError
    std::function<bool(int frame)> done;         ///< after each frame; false: stop, nothing is kept
    std::vector<ExportLook> looks = {};          ///< (cloths), or none
    std::vector<ExportSolid> solids = {};
    std::vector<ExportCamera> cameras = {};
    int frames() const { return last - first + 1; }
};

/// What was written, in order; empty where it was stopped.
using Written = std::vector<std::filesystem::path>;

/// frame_0000.obj …: every cloth an object of each, with texture coordinates, smooth normals and seams, and
/// after them every solid, where it is then. Positions have the digits that read back to the same doubles.
Written export_obj(const ExportSource& source, const std::filesystem::path& folder);

/// frame_0000.ply …, binary: positions as doubles, normals, and the colours of the component view (`colors`
/// is called for every frame from 0 on, in order), faces as they are.
Written export_ply(const ExportSource& source, const std::filesystem::path& folder,
                   const std::function<std::vector<Rgb>(const FrameRecord&)>& colors);

/// NAME.obj and NAME.pc2 (or NAME.mdd) for every cloth, and for every solid: its first frame as a mesh, and a
/// point cache that moves it. Positions are rounded to floats once.
Written export_point_cache(const ExportSource& source, const std::filesystem::path& folder, bool mdd);

/// Gives a source what is beside the scene's cloths: their looks, the solids, and the cameras if asked for.
/// Throws InputError where a texture can't be read.
void add_surroundings(ExportSource& source, const Scene& scene, bool cameras);

/// NAME.glb, binary glTF 2.0: every cloth, and every solid that deforms, a mesh with one morph target per
/// frame and an animation that is at the frame's own target at the frame's time; other solids and cameras
/// nodes that move. Textures are inside. `name` of the file.
Written export_glb(const ExportSource& source, const std::filesystem::path& folder, const std::string& name);

/// Where a solid's vertices are in the world at t [s]. (vertices) [m]
std::vector<Vec3> solid_positions(const ExportSolid& solid, double t);

/// A cloth's part of a state. [m]
std::span<const Vec3> positions_of(const ClothPatch& patch, const FrameRecord& record);

/// Unit normals of a surface, weighted by area; (0, 1, 0) where there is none. (vertices)
std::vector<Vec3> surface_normals(const ClothSurface& surface, std::span<const Vec3> x);

/// A name as that of a file: letters, digits, '-', '_' and '.'; others become '_'.
std::string file_name(const std::string& name);

/// The cloths' names, then the solids', as those of files, no two the same: what is taken gets "_2", "_3", …
std::vector<std::string> file_names(const ExportSource& source);

/// A solid as the lines of an OBJ file, its object called `name`, after `vertices` that stand there already.
std::string obj_text(const std::string& name, const ExportSolid& solid, std::span<const Vec3> x,
                     std::size_t vertices);

/// One cloth as the lines of an OBJ file, its object called `name`, after `vertices` and `uvs` that stand in
/// the file already.
std::string obj_text(const std::string& name, const ClothPatch& patch, const ClothSurface& surface,
                     std::span<const Vec3> x, std::size_t vertices, std::size_t uvs);

}  // namespace unravel::tool
