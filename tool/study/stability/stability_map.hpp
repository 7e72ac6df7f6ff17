#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// One run of the map: a stiffness, a step, and whether the run stayed bounded.
struct MapCell {
    double stretch = 0;  ///< N/m, of the material
    double step = 0;     ///< s
    double kappa = 0;    ///< of its stiffest spring (7)
    bool stable = true;
};

struct StabilityMap {
    std::string integrator;
    std::vector<MapCell> cells;
};

/// Runs the scene with an integrator over stiffnesses 10⁰ … 10⁶ N/m and steps of a whole frame down to 1/64
/// of it. Stable: no run is stopped, and the energy never doubles.
StabilityMap make_stability_map(const std::filesystem::path& scene, const std::string& integrator);

/// Draws each map with κ = ½ over it, as map_NAME.svg and .png, and writes all cells to map.csv. Returns the
/// names of the SVGs. Throws OutputError.
std::vector<std::string> write_stability_maps(const std::filesystem::path& folder,
                                              const std::vector<StabilityMap>& maps);

}  // namespace unravel::tool
