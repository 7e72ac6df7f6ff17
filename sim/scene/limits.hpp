#pragma once

// Bounds on a whole scene, so that a slip of the hand or a hostile file stops before memory does.

#include <cstddef>

namespace unravel::sim {

inline constexpr std::size_t max_scene_bytes = 4u << 20;  // of the file
inline constexpr int max_particles = 4'000'000;           // in all cloths together, and in one direction
inline constexpr std::size_t max_mesh_bytes = std::size_t{1} << 30;  // of one file of a mesh
inline constexpr std::size_t max_sample_bytes = std::size_t{2}
                                                << 30;  // of all samples of a mesh that deforms
inline constexpr std::size_t max_faults = 8;            // of one mesh, shown
inline constexpr int max_frames = 100'000;
inline constexpr double max_steps = 1e8;
inline constexpr double step_slack = 1e-6;         // relative, of a step that divides the frame
inline constexpr std::size_t max_list = 4096;      // cloths, solids, pins, keyframes: tables in one list
inline constexpr std::size_t max_includes = 16;    // files that a scene takes over, those of others included
inline constexpr std::size_t max_problems = 1000;  // kept; a file that is no scene has no end of them
inline constexpr std::size_t max_key_parts = 16;   // of a dotted key

}  // namespace unravel::sim
