#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/forces/stencil.hpp"
#include "sim/model/model.hpp"
#include "sim/model/report.hpp"
#include "sim/terms/effects.hpp"

namespace unravel::sim {

struct ForceMemory;       // sim/terms/terms.hpp
struct MeasureWorkspace;  // sim/terms/measure.hpp
struct RowVersion;        // sim/terms/row_version.hpp

/// What scheme and options decide about the forces of a step.
struct ForceSettings {
    double h = 0;  ///< s, of the step
    Splitting splitting;
    double band = 0;            ///< see extension_forces()
    bool all_explicit = false;  ///< nothing may be implicit, so that there is no linear system
    friend bool operator==(const ForceSettings&, const ForceSettings&) = default;
};

/// Where a step takes forces. Spans are (particles) unless said.
struct ForcesAt {
    ForceSettings settings;
    double t = 0, t_end = 0;             ///< s, when the step begins and ends
    std::span<const Vec3> x, v;          ///< x* [m] and v* [m/s] (sim/integrators/scheme.hpp)
    std::span<const Vec3> ahead;         ///< where implicit springs are linearised [m]; empty: at x*
    std::span<const std::uint8_t> taut;  ///< (springs) see extension_forces(); or empty
    /// Where springs that know no look ahead are evaluated even so: how far particles move from there without
    /// the solve [m]; empty: as the others'.
    std::span<const Vec3> drift_from_start;
    std::span<const Vec3> linearised_at() const { return ahead.empty() ? x : ahead; }
};

/// A step as a force sees it afterwards. Spans are (particles).
struct StepEnds {
    ForceSettings settings;
    double t = 0;                          ///< s, when it began
    std::span<const Vec3> x, v;            ///< where it began [m], [m/s]
    std::span<const Vec3> x_next, v_next;  ///< where it has ended
};

/// What forces couple particles by; the cloths' own springs come first.
struct StepCouplings {
    std::vector<SpringFamily> springs;
    std::vector<Stencils> stencils;
    std::optional<BendCouplings> bending;
    operator Couplings() const { return {springs, stencils, bending ? &*bending : nullptr}; }
};

/// A force that acts on the cloth: all that a step, its measures, the guard and `check` ask of it. A new one
/// is its pair of files and its line in sim/terms/terms.hpp; functions that it has no use for stay null.
///
/// It either pushes, always explicitly, or acts by springs, which may be implicit and enter the linear
/// system. What it keeps from call to call, and between steps, is its own member of ForceMemory.
struct ForceTerm {
    const char* name;
    /// Whether a model calls for it: otherwise nothing of it runs, and nothing is allocated.
    bool (*acts)(const ClothModel& model);

    /// Makes what depends on the size of a step, where it isn't there already.
    void (*prepare)(const ClothModel& model, double h, ForceMemory& memory) = nullptr;

    /// A force that pushes: adds it, (particles) [N]. Evaluated where a step begins, and kept for all of the
    /// step.
    void (*push)(const ClothModel& model, const ForcesAt& at, ForceMemory& memory,
                 std::span<Vec3> force) = nullptr;

    /// A force that pushes, and in places changes too fast with velocity to be kept for all of a step: finds
    /// those where the step begins. Their answer to what has changed since is then evaluated, added and
    /// coupled as springs are, with every linearisation; where nothing is found, these do nothing. Not called
    /// where all is explicit.
    void (*stiffen)(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) = nullptr;

    /// A force by springs: evaluates them at (x*, v*), with their Jacobians where they are implicit; then
    /// adds their forces, (particles) [N]; then hands those that may be implicit to the linear system.
    void (*evaluate)(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) = nullptr;
    void (*add)(const ClothModel& model, const ForceMemory& memory, std::span<Vec3> force) = nullptr;
    void (*couple)(const ClothModel& model, const ForcesAt& at, const ForceMemory& memory,
                   StepCouplings& out) = nullptr;
    /// Whether the settings may make some of its springs implicit; null: never.
    bool (*may_be_implicit)(const ClothModel& model, const ForceSettings& settings) = nullptr;

    /// The same force along the rows of grids, which pushes or splits springs; null: a cloth on which it acts
    /// takes the general path.
    const RowVersion* rows = nullptr;
    /// Rows do without its own version, because what moves them adds it by itself.
    bool part_of_rows = false;

    /// Adds its energy at x to the report's potential [J], and fills in what else a report tells of it.
    void (*measure)(const ClothModel& model, std::span<const Vec3> x, const ForceMemory& memory,
                    MeasureWorkspace& ws, StepReport& report) = nullptr;
    /// J, at least 0, that it has put in over a step beyond what it measures; null: it only takes, or gives
    /// back what is measured. Asked for after the step, and where energy has grown.
    double (*put_in)(const ClothModel& model, const StepEnds& step, ForceMemory& memory) = nullptr;
    /// J by which what it measures has changed over a step beyond what its explicit forces, kept all along,
    /// have taken from the motion: E(x') − E(x) + f(x)·(x' − x) of each explicit spring; null: none.
    double (*explicit_gain)(const ClothModel& model, const StepEnds& step, const ForceMemory& memory,
                            MeasureWorkspace& ws) = nullptr;
    /// Fills in what a report tells of the springs as they were evaluated.
    void (*count)(const ForceMemory& memory, StepReport& report) = nullptr;
    /// The stage that its time belongs to.
    double StageTimes::*time = &StageTimes::forces;

    /// What `check` and run.json say of it, on or off, by effects of their own.
    void (*effects)(const Scene& scene, std::vector<Effect>& effects) = nullptr;
};

/// Adds the forces of springs on their ends, (springs) [N] on the lower-numbered one: to each particle in the
/// order of its springs.
inline void add_by_spring(const Adjacency& adjacency, std::span<const Vec3> of_spring,
                          std::span<Vec3> force) {
    parallel_each(force.size(), [&](std::size_t p) {
        Vec3& f = force[p];
        adjacency.each(static_cast<std::uint32_t>(p), [&](std::uint32_t s, std::uint32_t other) {
            f += other > p ? of_spring[s] : Vec3(-of_spring[s]);
        });
    });
}

}  // namespace unravel::sim
