#pragma once

#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/cluster/cluster.hpp"
#include "tool/picture/clip.hpp"
#include "tool/picture/picture_stamp.hpp"

namespace unravel::tool {

/// A clip's frames cut into ranges that are drawn apart, by several tasks into one folder. Beside its
/// pictures each range leaves the stamp that they were drawn with; the tasks share no other file.

/// first … last as `parts` ranges of nearly equal length, or one per frame where there are fewer; 0: as many
/// as are worth a task each.
std::vector<FrameRange> cut_frames(int first, int last, int parts);

/// The ranges that are not drawn yet, as work for a cluster.
///   scene    as it is drawn
///   cached   the run, whose folder may be another than `folder`, that of the pictures
ClusterWork range_work(const std::vector<FrameRange>& ranges, const Scene& scene, const RunFolder& cached,
                       const RunFolder& folder, const ClipOptions& clip);

/// Makes `clip` that of this one range.
void narrow_to_range(const FrameRange& range, ClipOptions& clip);

/// Sees that every range lies there, drawn alike, and makes `clip` one that takes them all over. Throws
/// MissingPieces that names those missing, FolderError that names the renderers where there was more than
/// one.
void gather_ranges(const std::vector<FrameRange>& ranges, const Scene& scene, const RunFolder& folder,
                   ClipOptions& clip);

}  // namespace unravel::tool
