#pragma once

#include <span>
#include <string_view>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

struct MaterialPreset {
    std::string_view name;
    double density;  ///< kg/m²
    Material material;
};

std::span<const MaterialPreset> material_presets();
std::span<const std::string_view> preset_names();

/// Null if there is none of that name.
const MaterialPreset* find_preset(std::string_view name);

}  // namespace unravel::sim
