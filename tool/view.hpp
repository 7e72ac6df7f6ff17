#pragma once

#include <filesystem>

#include "render/draw_scene.hpp"
#include "render/palette.hpp"
#include "sim/frame_record.hpp"
#include "sim/model.hpp"
#include "sim/scene/scene.hpp"

namespace unravel {

/// What the renderer needs of a scene for the whole clip. `textures`: the folder that the scene's pictures
/// are named relative to; empty: cloths show their weaves. Throws InputError where a picture can't be read.
DrawScene make_draw_scene(const Scene& scene, const ClothModel& model, const Placement& placement,
                          const std::filesystem::path& textures = {});

/// Edges of the component view, as particle pairs in DrawScene's order: the stretch springs.
std::vector<std::array<std::uint32_t, 2>> drawn_edges(const ClothModel& model);

/// One frame of it, seen by the scene's camera of this index. `colors` must have seen every earlier frame, in
/// order: colours are stable in time.
void make_draw_frame(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                     const std::vector<Rgb>& particle_colors, DrawFrame& out, std::size_t camera = 0);

/// Camera of the scene at time t: keyframes, then the orbit about its target.
CameraView camera_at(const Scene& scene, const Camera& camera, double t);

/// "#rrggbb"; anything else throws std::invalid_argument (a checked scene holds nothing else).
Rgb parse_color(const std::string& text);

}  // namespace unravel
