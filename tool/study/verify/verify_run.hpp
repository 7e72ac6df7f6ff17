#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/run/simulate.hpp"
#include "tool/study/verify/verify_case.hpp"

namespace unravel::tool {

/// Grids and steps of a case. The first of both are what a fast run takes.
struct VerifyLadder {
    std::vector<std::array<int, 2>> grids;  ///< particles along u and v
    std::vector<double> steps;              ///< 1/s: 240 is a step of 1/240 s
};

/// m/s², as scenes have it where they say nothing.
inline constexpr double gravity = 9.81;

inline const std::vector<double> common_steps{240, 600, 2000};

/// Calls measure(grid, steps per second) for every grid and step of a ladder and makes a line of each, with
/// `tolerance` relative to what is expected. A run that throws is a line that fails.
void add_lines(const VerifyLadder& ladder, bool fast, const std::string& of, double expected,
               double tolerance, const std::function<double(std::array<int, 2>, double)>& measure,
               std::vector<VerifyLine>& lines);

/// The scene of a text, at its start.
Simulation verify_simulation(const std::string& scene);

/// Steps until `time` [s].
void run_until(Simulation& simulation, double time);

/// Mean position of all particles, by mass [m].
Vec3 centre_of(const Simulation& simulation);

/// Energy of the springs as they stand, without that of height [J].
double spring_energy(Simulation& simulation);

}  // namespace unravel::tool
