#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/stencil.hpp"
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
/// a quarter (of a triangle: a third) to each corner.
///   h  s, of a step that takes the force for constant: it is at most what brings a cell to the air's speed
///      within it; 0: of one that does not (StiffAir)
///   mass, x, v  (particles);  force  (cells) on the whole cell [N]
void air_forces(const AirCells& air, const Wind& wind, double t, double h, std::span<const double> mass,
                std::span<const Vec3> x, std::span<const Vec3> v, std::span<Vec3> force);

/// Whether the air can do anything at all: it has a density, and a coefficient.
bool acts(const Wind& wind);

/// Cells whose force air_forces() makes less than the law says, for steps of h seconds from (x, v) at time t.
std::uint32_t held_back(const AirCells& air, const Wind& wind, double t, double h,
                        std::span<const double> mass, std::span<const Vec3> x, std::span<const Vec3> v);

/// Cells that the air would bring to more than half of its own speed within a step, if its force stayed what
/// it is where the step begins: light cloth, strong wind. Their force is linear in the velocity at the step's
/// end, with the coefficients of its beginning,
///   F = ½ ρ A (C_d |r·n| (r'·n) n + C_l |r| (r' − (r'·n) n)),
/// so that it brings them to the air's speed and never beyond, however large the step: what is held has the
/// whole force.
struct StiffAir {
    std::vector<Stencil> cells;  ///< each one's mean velocity, damped by the two coefficients
    std::vector<Vec3> start;     ///< (stiff cells) that velocity where the step began [m/s]
    std::vector<Vec3> answer;    ///< (stiff cells) what has been added to the force by its change [N]
};
/// Finds them for a step of h seconds from (x, v), at time t.
void find_stiff_air(const AirCells& air, const Wind& wind, double t, double h, std::span<const double> mass,
                    std::span<const Vec3> x, std::span<const Vec3> v, StiffAir& out);
/// Fills in their answer at velocities v (particles) [m/s].
void answer_stiff_air(std::span<const Vec3> v, StiffAir& stiff);

/// Adds each particle's share of its cells' forces, (cells) [N], to `force`, (particles).
void add_air(const AirCells& air, std::span<const Vec3> of_cell, std::span<Vec3> force);

}  // namespace unravel::sim
