#pragma once

#include "tool/base/names.hpp"
#include "tool/cluster/cluster.hpp"
#include "tool/study/accuracy/accuracy_study.hpp"

namespace unravel::tool {

/// A study in pieces that don't depend on each other: the points of its grid, each timed alone.

/// Times point `index` of the grid as often as all are, into a file of its own, unless that was done. False:
/// keep_on ended it. Throws MissingPieces where the folder holds no reference of the scene.
bool time_accuracy_point(const Scene& scene, const std::filesystem::path& folder, int index,
                         const std::function<bool()>& keep_on);

/// What the points that lie there give, in the order of the grid, saved as accuracy.csv. Throws MissingPieces
/// where the folder holds no reference.
///   missing  which others there should be, and why they are not, one to a line; for people
AccuracyStudy collect_accuracy(const Scene& scene, const std::filesystem::path& folder, std::string& missing);

/// The points that are not timed yet, as work for a cluster.
ClusterWork accuracy_cluster_work(const Scene& scene, const std::filesystem::path& folder, bool force);

}  // namespace unravel::tool
