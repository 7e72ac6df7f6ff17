#pragma once

#include "sim/self_collision/surface_contact.hpp"

namespace unravel::sim {

/// What a contact's spring and friction are made of.
struct ContactPush {
    double lacking = 0;      ///< m, thickness − n·r as the springs of this step see it at its start
    double depth = 0;        ///< m, how much too near it is at the start
    double depth_ahead = 0;  ///< m, and would be at the end
    Vec3 speed{0, 0, 0};     ///< m/s, ṙ
    double stiffness = 0;    ///< N/m
    double damping = 0;      ///< N·s/m; 0: a fifth of critical
    Friction friction;
};

/// What is too near by `depth` metres is pushed apart no faster than this, so that no spring gives back as
/// motion what an impact has taken [m/s].
inline constexpr double opening_speed = 0.05;
inline double opened_within(double h, double depth) {
    return depth < opening_speed * h ? depth : opening_speed * h;
}

/// Completes a contact of which weights and normal are known; `inverse_mass` is Σ w²/m [1/kg].
void press(const ContactPush& push, double inverse_mass, double h, double threshold, SurfaceContact& out);

/// Appends what was found, chunk by chunk.
void add_found(SurfaceContactWorkspace& ws);

}  // namespace unravel::sim
