#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace unravel::sim {

/// Seconds spent in each stage of a step.
struct StageTimes {
    double contact = 0, collision = 0, air = 0, forces = 0, graph = 0, assembly = 0, solve = 0, advance = 0;
    double measure = 0, compare = 0;
    /// The step itself: without measuring it, and without the whole-system solve that it may be compared
    /// with.
    double step() const { return contact + collision + air + forces + graph + assembly + solve + advance; }
    StageTimes& operator+=(const StageTimes& other) {
        for (double StageTimes::*slot :
             {&StageTimes::contact, &StageTimes::collision, &StageTimes::air, &StageTimes::forces,
              &StageTimes::graph, &StageTimes::assembly, &StageTimes::solve, &StageTimes::advance,
              &StageTimes::measure, &StageTimes::compare})
            this->*slot += other.*slot;
        return *this;
    }
};

/// What one step was, in the quantities that stats.csv lists (one row per step).
struct StepReport {
    std::uint64_t step = 0;  ///< 1 for the first
    double t = 0;            ///< s, at its end
    double h = 0;            ///< s
    std::uint32_t components = 0;
    std::uint32_t largest = 0;                                ///< particles
    std::uint32_t constrained = 0;                            ///< particles with no free direction
    std::uint32_t partly = 0;                                 ///< particles with one or two
    std::uint32_t implicit = 0, explicit_ = 0, inactive = 0;  ///< stretch and shear springs
    std::uint64_t cg_iterations = 0;                          ///< summed over components
    std::uint32_t cg_iterations_max = 0;
    std::uint64_t rvm = 0;                   ///< row–vector multiplies
    std::optional<std::uint64_t> rvm_whole;  ///< the same system undecomposed; only where it was asked for
    double whole_difference = 0;             ///< largest difference of the two solutions [m/s]
    bool converged = true;                   ///< every component reached the tolerance
    std::uint32_t substeps = 1;              ///< parts that an explicit step was divided into
    std::uint32_t rejected = 0;  ///< attempts undone before this one (guarded_step(), adaptive_step())
    std::uint32_t contacts = 0;
    /// Temporary springs of self-collision; they count as implicit or explicit too.
    std::uint32_t self_contacts = 0;
    double self_distance = 0;  ///< m, least between particles that may collide, at most the thickness
    /// At the end of a frame's last step (sim/run/passages.hpp): edges of cloth through faces of cloth, edges
    /// through solids, and how deep cloth is in a solid [m]. Absent elsewhere, and where nothing can meet.
    std::optional<std::uint64_t> crossings, in_solids;
    double deepest = 0;
    /// At the same places: cells that an explicit step spares a part of the air's force (held_back()).
    std::uint32_t air_held = 0;
    double max_strain = 0, p99_strain = 0;  ///< of stretch springs, (l − L)/L
    std::uint32_t strained = 0;             ///< the stretch spring of largest strain
    std::uint32_t pulling = 0;              ///< contacts with solids that stay though they pull
    double lowest = 0;                      ///< m, lowest particle's y
    double kinetic = 0, potential = 0;      ///< J; gravity's zero is at y = 0
    StageTimes times;
};

/// Adds the time since it was made, or since the last lap, to a slot.
class StageTimer {
public:
    void lap(double& slot) {
        const auto now = std::chrono::steady_clock::now();
        slot += std::chrono::duration<double>(now - last_).count();
        last_ = now;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace unravel::sim
