#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/study/accuracy/accuracy.hpp"

namespace unravel::tool {

/// A study as far as it got.
struct AccuracyStudy {
    Scene scene;
    AccuracyReference reference;
    std::vector<AccuracyPoint> points;
    int skipped = 0;       ///< settings that did not fit the budget
    bool stopped = false;  ///< by keep_on
    double window() const { return scene.clip.fps.time_of(reference.frames); }  ///< s
    const AccuracyPoint* find(const AccuracySetting& setting) const;  ///< null: not among the points
};

/// What a study keeps, each file whole at any time: scene.toml, reference.bin, accuracy.csv, and in points/
/// those that were timed one by one, each in a file of its own, so that many may write at once.
class AccuracyFolder {
public:
    /// Changes nothing. Throws InputError if the folder can't be read.
    AccuracyFolder(const Scene& scene, const std::filesystem::path& folder, bool force);
    bool holds_study() const { return holds_study_; }  ///< of this very scene, with its reference
    /// The study that it holds. Throws InputError if its reference is damaged.
    AccuracyStudy read() const;
    /// Makes the folder this scene's: what a study of another has left is removed.
    void begin() const;
    /// Begins anew: what it holds is of another window.
    void forget() {
        holds_study_ = false;
        begin();
    }
    void save_reference(const AccuracyReference& reference) const;
    void save_points(const std::vector<AccuracyPoint>& points) const;  ///< all, in accuracy.csv
    void save_point(const AccuracyPoint& point) const;                 ///< one, in its own file
    std::filesystem::path point_file(const AccuracySetting& setting) const;
    const std::filesystem::path& path() const { return folder_; }

private:
    std::filesystem::path csv() const { return folder_ / "accuracy.csv"; }
    std::filesystem::path reference() const { return folder_ / "reference.bin"; }
    std::filesystem::path points() const { return folder_ / "points"; }

    const Scene& scene_;
    std::filesystem::path folder_;
    bool holds_study_ = false;
};

}  // namespace unravel::tool
