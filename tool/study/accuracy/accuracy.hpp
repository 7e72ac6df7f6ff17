#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/model.hpp"
#include "sim/scene/math.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// The study of what accuracy costs in time: its settings, what a run of one gives, and the run itself.

/// One way to compute the scene.
struct AccuracySetting {
    Integrator integrator = Integrator::adaptive_imex;
    int steps_per_frame = 1;  ///< of `explicit`: substeps of one step a frame, which costs least
    double threshold = 0.2;   ///< of the adaptive schemes
    double tolerance = 1e-3;  ///< of CG
    Activation activation = Solver{}.activation;
    double band = 0;  ///< the default's costs accuracy (docs/accuracy.md)
    BendTreatment bend = BendTreatment::scheme;
    /// "adaptive-imex", "adaptive-imex threshold 0.05": all but the step, by which curves are drawn.
    std::string method() const;
    /// Neither threshold, tolerance, activation nor bending departs from what all methods have in common.
    bool plain() const;
    bool operator==(const AccuracySetting&) const = default;
};

struct AccuracyPoint {
    AccuracySetting setting;
    bool broke = false;  ///< blew up, or left the reference by a cloth's diagonal
    double error = 0;    ///< RMS distance from the reference over particles and frames, over the diagonal
    double max_strain = 0, lowest = 0, energy = 0;  ///< greatest, at the end [m], at the end [J]
    std::uint64_t steps = 0, rvm = 0;
    std::string node, processor;  ///< where it was timed
    std::vector<double> seconds;  ///< of the steps alone, one per run
    double median() const;
    double fastest() const;
    double slowest() const;
    double quantile(double share) const;  ///< of the times, by nearest rank
};

/// As the scene file has it.
const char* integrator_name(Integrator integrator);

/// The scene's own solver as a setting.
AccuracySetting scene_setting(const Scene& scene);

/// Frames of the clip over which settings are compared: from `first` to `last`, or as far as references
/// agree.
struct AccuracyWindow {
    int first = 0;
    std::optional<int> last;  ///< absent: chosen
};

/// Positions at the frames after a window's first. (frames) × (particles) [m]
using Trajectory = std::vector<std::vector<Vec3>>;

/// Runs a setting over `frames` frames from a start that all settings share, or from the scene's own where it
/// is empty.
///   t0       s, when that is
///   keep_on  asked after each frame; false ends the run, which then counts as broken
struct AccuracyRun {
    AccuracyPoint point;  ///< with one time
    Trajectory trajectory;
    bool stopped = false;
};
AccuracyRun run_setting(const Scene& scene, const AccuracySetting& setting, int frames,
                        const std::function<bool()>& keep_on, const Placement& start = {}, double t0 = 0);

/// RMS distance of two trajectories over the frames that both have, over the cloth's diagonal.
double distance(const Trajectory& a, const Trajectory& b, double diagonal);

/// Diagonal of the scene's largest cloth at rest [m].
double diagonal_of(const Scene& scene);

/// What everything is measured against: a run with very small steps, and a second one by another integrator
/// that says how far it can be trusted.
struct AccuracyReference {
    AccuracySetting first, second;
    int first_frame = 0;  ///< at which the window starts
    int asked = 0;        ///< frames that it was asked for; 0: it was to choose
    Placement start;      ///< where everything is and goes then, by the scene's own solver
    Trajectory trajectory;
    double floor = 0;  ///< their distance
    int frames = 0;  ///< of the window: as asked for, until the two part by more than `parted`, or time ends
};

/// Where two references part by more than this share of the diagonal, trajectories are no longer comparable.
inline constexpr double parted = 1e-3;
/// The window is at least this long where the scene is [s].
inline constexpr double least_window = 0.2;

/// A reference takes at most so many steps a frame.
inline constexpr int finest_reference = 4096;

/// Computes it in at most about `seconds`: with as small steps as fit, and where even coarse ones don't, over
/// as many frames as fit, one at least.
AccuracyReference make_reference(const Scene& scene, const AccuracyWindow& window, double seconds,
                                 const std::function<bool()>& keep_on);

/// The reference as a file's bytes, and back. Throws InputError if the bytes are no reference of `particles`.
std::string reference_bytes(const AccuracyReference& reference);
AccuracyReference read_reference(const std::filesystem::path& file, std::size_t particles);

/// The settings of a study: the scene's own, then those that matter most; within a method from large steps to
/// small.
std::vector<AccuracySetting> accuracy_grid(const AccuracyReference& reference, const Scene& scene);

/// The CSV with every point, and back. Rows that do not parse are left out.
std::string accuracy_csv(const std::vector<AccuracyPoint>& points);
std::vector<AccuracyPoint> read_accuracy_csv(const std::string& csv);

}  // namespace unravel::tool
