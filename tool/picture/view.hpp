#pragma once

#include <filesystem>

#include "render/draw_scene.hpp"
#include "render/palette.hpp"
#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/picture/camera_path.hpp"
#include "tool/picture/staging.hpp"

namespace unravel::tool {

/// What the renderer needs of a scene for the whole clip. `textures`: the folder that the scene's pictures
/// are named relative to; empty: cloths show their weaves. Throws InputError where a picture can't be read.
DrawScene make_draw_scene(const Scene& scene, const ClothModel& model, const Placement& placement,
                          const std::filesystem::path& textures = {});

/// Edges of the component view, as particle pairs: stretch springs, where the splitting is shown shear too.
std::vector<std::array<std::uint32_t, 2>> drawn_edges(const ClothModel& model, Show show = Show::components);

/// Throws InputError where a texture that the scene names is no picture; `textures`: their folder.
void check_textures(const Scene& scene, const std::filesystem::path& textures);

/// Time of a frame within its clip [s].
double frame_time(const Scene& scene, int frame);

/// One frame of it, seen by the scene's camera of this index. `components`: colours of particles by
/// component, which must have seen every earlier frame, in order: they are stable in time. `drawn`: of
/// make_draw_scene().
void make_draw_frame(const Scene& scene, const ClothModel& model, const DrawScene& drawn,
                     const FrameRecord& record, const std::vector<Rgb>& components, DrawFrame& out,
                     std::size_t camera = 0);

/// `count` times at which a frame's shutter is open, evenly spread over the time before it [s]; one for
/// frame 0.
std::vector<double> exposure_times(const Scene& scene, int frame, int count);

/// The same frame at each of its exposure times, without cameras. `previous`: the state one frame earlier,
/// from which positions are interpolated with their velocities; null: there is none, and one exposure.
void make_exposures(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                    const ClothState* previous, const std::vector<Rgb>& components, int count,
                    std::vector<DrawFrame>& out);

}  // namespace unravel::tool
