#pragma once

#include <optional>

#include "tool/base/names.hpp"
#include "tool/study/accuracy/accuracy_folder.hpp"

namespace unravel::tool {

struct AccuracyBudget {
    double seconds = 600;  ///< for everything
    bool force = false;    ///< forget what an earlier study left in the folder
    bool quiet = false;
    double after = 0;         ///< s, what is to follow and counts as time left
    double error = 1e-3;      ///< to be borne: a method is not refined beyond it
    AccuracyWindow window{};  ///< of the clip
};

/// Times of a point on one machine: so many make its median.
inline constexpr std::size_t wanted_runs = 5;

/// Computes the reference, runs every setting of the grid once, those that matter first, and then times those
/// near the front again and again, all in turn, so that a busy spell of the machine falls on all. A study of
/// the same scene in the same folder goes on where the last one ended.
///   keep_on  asked before each frame; false ends the study with what it has
AccuracyStudy study_accuracy(const Scene& scene, const std::filesystem::path& folder,
                             const AccuracyBudget& budget, const std::function<bool()>& keep_on);

/// The reference alone, where the folder does not hold it yet. False: keep_on ended it.
bool study_reference(const Scene& scene, const std::filesystem::path& folder, const AccuracyBudget& budget,
                     const std::function<bool()>& keep_on);

/// One run of a setting against the study's reference; nothing where keep_on ended it.
std::optional<AccuracyPoint> measure_point(const AccuracyStudy& study, const AccuracySetting& setting,
                                           const std::function<bool()>& keep_on);

}  // namespace unravel::tool
