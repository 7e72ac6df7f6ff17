#pragma once

#include <filesystem>
#include <optional>

#include "tool/base/names.hpp"
#include "tool/study/stability/stability_map.hpp"
#include "tool/study/stability/stability_report.hpp"

namespace unravel::tool {

/// Pieces of a stability study that were done apart: each is a file under the case's or the integrator's own
/// name, which also says what it was made from. Another scene, other bounds or another version of the tool
/// make it one that is not there.

/// `pictures`: one was to be drawn.
void write_hard_line(const std::filesystem::path& output, const HardLine& line, bool pictures);
std::optional<HardLine> read_hard_line(const std::filesystem::path& output, const HardCase& hard,
                                       bool pictures);

void write_map_piece(const std::filesystem::path& output, const std::filesystem::path& scene,
                     const StabilityMap& map);
std::optional<StabilityMap> read_map_piece(const std::filesystem::path& output,
                                           const std::filesystem::path& scene, const std::string& integrator);

/// Integrators that have a map.
inline constexpr const char* mapped_integrators[] = {"explicit",       "imex",     "adaptive-imex",
                                                     "adaptive-imex2", "implicit", "bdf2"};

}  // namespace unravel::tool
