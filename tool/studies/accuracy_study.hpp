#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tool/studies/accuracy.hpp"

namespace unravel {

struct AccuracyBudget {
    double seconds = 600;  ///< for everything
    bool force = false;    ///< forget what an earlier study left in the folder
    bool quiet = false;
};

/// A study as far as it got.
struct AccuracyStudy {
    Scene scene;
    AccuracyReference reference;
    std::vector<AccuracyPoint> points;
    int skipped = 0;       ///< settings that did not fit the budget
    bool stopped = false;  ///< by keep_on
    double window() const { return static_cast<double>(reference.frames) / scene.clip.fps; }  ///< s
};

/// Computes the reference, runs every setting of the grid once, those that matter first, and then times those
/// near the front again and again, all in turn, so that a busy spell of the machine falls on all. The folder
/// keeps scene.toml, reference.bin and accuracy.csv, each whole at any time: a study of the same scene in the
/// same folder goes on where the last one ended.
///   keep_on  asked before each frame; false ends the study with what it has
AccuracyStudy study_accuracy(const Scene& scene, const std::filesystem::path& folder,
                             const AccuracyBudget& budget, const std::function<bool()>& keep_on);

}  // namespace unravel
