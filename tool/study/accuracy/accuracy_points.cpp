#include "tool/study/accuracy/accuracy_points.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tool/cluster/job_script.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"

namespace unravel::tool {

namespace {

AccuracyStudy study_with_reference(const AccuracyFolder& folder) {
    if (folder.holds_study()) return folder.read();
    const bool tried = std::filesystem::exists(job_log(folder.path(), "accuracy_before"));
    throw MissingPieces(fmt::format("'{}' holds no reference of this scene{}", folder.path().string(),
                                    tried ? ": " + why_missing(folder.path(), "accuracy_before", -1) : ""));
}

// Timed as often as is wanted, on the processor that most were timed on.
bool is_timed(const AccuracyStudy& study, const AccuracySetting& setting) {
    const AccuracyPoint* point = study.find(setting);
    return point && (point->broke || (point->seconds.size() >= wanted_runs &&
                                      point->processor == processor_of_most(study.points)));
}

}  // namespace

bool time_accuracy_point(const Scene& scene, const std::filesystem::path& path, int index,
                         const std::function<bool()>& keep_on) {
    const AccuracyFolder folder(scene, path, false);
    const AccuracyStudy study = study_with_reference(folder);
    const std::vector<AccuracySetting> grid = accuracy_grid(study.reference, scene);
    // Before the reference is known, more points are sent than it may turn out to allow.
    if (static_cast<std::size_t>(index) >= grid.size()) return true;
    const AccuracySetting& setting = grid[static_cast<std::size_t>(index)];
    if (is_timed(study, setting)) return true;
    std::optional<AccuracyPoint> point = measure_point(study, setting, keep_on);
    while (point && !point->broke && point->seconds.size() < wanted_runs) {
        const std::optional<AccuracyPoint> again = measure_point(study, setting, keep_on);
        if (!again) return false;
        point->seconds.push_back(again->seconds.front());
    }
    if (!point) return false;
    folder.save_point(*point);
    return true;
}

AccuracyStudy collect_accuracy(const Scene& scene, const std::filesystem::path& path, std::string& missing) {
    const AccuracyFolder folder(scene, path, false);
    AccuracyStudy study = study_with_reference(folder);
    const std::vector<AccuracySetting> grid = accuracy_grid(study.reference, scene);
    const auto place = [&](const AccuracyPoint& p) { return std::find(grid.begin(), grid.end(), p.setting); };
    std::stable_sort(study.points.begin(), study.points.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
    folder.save_points(study.points);
    for (std::size_t k = 0; k < grid.size(); ++k) {
        if (!study.find(grid[k]))
            missing += fmt::format("\n  {}, steps of {} s: {}", grid[k].method(),
                                   step_text(scene.clip.fps, grid[k].steps_per_frame),
                                   why_missing(path, "accuracy", static_cast<int>(k)));
    }
    return study;
}

ClusterWork accuracy_cluster_work(const Scene& scene, const std::filesystem::path& path, bool force) {
    const AccuracyFolder folder(scene, path, force);
    AccuracyStudy study;
    study.reference.first.steps_per_frame = finest_reference;
    if (folder.holds_study()) study = folder.read();
    const std::vector<AccuracySetting> grid = accuracy_grid(study.reference, scene);
    ClusterWork work;
    work.name = "accuracy";
    work.what =
        fmt::format("point K of {} at most, counted from 0, of the study of {}", grid.size(), scene.name);
    work.results = path;
    if (!folder.holds_study()) work.before = "--reference";
    work.alone = true;
    work.prepare = [folder] { folder.begin(); };
    for (std::size_t k = 0; k < grid.size(); ++k) {
        if (!is_timed(study, grid[k])) work.missing.push_back(static_cast<int>(k));
    }
    work.unit = "point";
    work.total = static_cast<int>(grid.size());
    work.done = [folder, grid, missing = work.missing] {
        const auto open = std::count_if(missing.begin(), missing.end(), [&](int k) {
            return !std::filesystem::exists(folder.point_file(grid[static_cast<std::size_t>(k)]));
        });
        return static_cast<int>(grid.size()) - static_cast<int>(open);
    };
    return work;
}

}  // namespace unravel::tool
