#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// One component of a step, as tables show it.
struct ComponentRow {
    std::int32_t id = 0;  ///< by smallest particle, within its step
    Rgb color;
    std::uint32_t particles = 0;
    std::uint32_t boundary = 0;  ///< fully constrained particles that implicit springs tie it to
    std::uint32_t springs = 0;   ///< implicit stretch and shear springs within it and to its boundary
    ComponentSolve solve;        ///< zero before the first step
};

/// All components of a frame's last step, largest first, equal ones by id. `colors` (particles) as drawn.
std::vector<ComponentRow> component_table(const ClothModel& model, std::span<const std::int32_t> component,
                                          std::span<const SpringState> springs,
                                          std::span<const ComponentSolve> solves,
                                          std::span<const Rgb> colors);

}  // namespace unravel::tool
