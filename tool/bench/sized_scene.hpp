#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Numbers of particles from "2500,10000,40000": ascending, each once. Throws UsageError with what is wrong.
std::vector<std::size_t> parse_sizes(const std::string& text);

/// Particles along u and v of a cloth of about n that keeps another's proportion.
std::array<int, 2> particles_near(std::size_t n, const std::array<int, 2>& of);

/// The scene with a cloth of about n particles in place of its own. Throws SceneError; UsageError where its
/// cloth is no single grid.
Scene scene_of_size(const std::filesystem::path& file, std::vector<std::string> overrides, std::size_t n);

}  // namespace unravel::tool
