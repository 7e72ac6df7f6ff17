#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/scene/math.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Cells of the cloth on which the air acts, and which of them each particle borders. Empty unless the scene
/// has wind.
struct AirCells {
    std::vector<std::array<std::uint32_t, 4>>
        corners;  ///< (cells) particles, in order round the cell; a triangle repeats its last
    std::vector<std::uint32_t> start;  ///< (particles + 1) of `cells`
    std::vector<std::uint32_t> cells;  ///< cells round each particle
};

/// 3 or 4.
inline std::size_t corner_count(const std::array<std::uint32_t, 4>& corners) {
    return corners[2] == corners[3] ? 3 : 4;
}

/// Which cells each particle borders, from their corners.
void connect_cells(std::size_t particles, AirCells& air);

/// The wind's velocity at time t [m/s]: constant or keyframed, times a smooth seeded gust.
Vec3 wind_velocity(const Wind& wind, double t);

/// Air resistance and lift per cell after Eberhardt, Weber & Straßer 1996: with r = w − v the wind relative
/// to the cell, n its unit normal and A its area,
///   F = ½ ρ A (C_d |r·n| (r·n) n + C_l |r| (r − (r·n) n)),
/// a quarter (of a triangle: a third) to each corner. The air can bring a cell to its own speed within a
/// step, never beyond.
///   mass, x, v  (particles);  force  (cells) on the whole cell [N]
void air_forces(const AirCells& air, const Wind& wind, double t, double h, std::span<const double> mass,
                std::span<const Vec3> x, std::span<const Vec3> v, std::span<Vec3> force);

/// Adds each particle's share of its cells' forces, (cells) [N], to `force`, (particles).
void add_air(const AirCells& air, std::span<const Vec3> of_cell, std::span<Vec3> force);

}  // namespace unravel::sim
