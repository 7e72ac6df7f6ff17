#include "tool/cli/frame_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tool/base/exit.hpp"
#include "tool/picture/picture_stamp.hpp"

namespace unravel::tool {

namespace {

// A range for at least so many frames: every task reads the run from its start, for the colours' sake.
constexpr int worth_a_task = 24;
constexpr int most_tasks = 64;

// Drawn with this stamp, but for the renderer, which only the node knows that drew it.
bool is_drawn(const RunFolder& folder, const ClipOptions& clip, const std::string& stamp,
              const FrameRange& range) {
    return std::ranges::all_of(clip.views, [&](const ClipView& view) {
        const std::string drawn = stamp_of_range(folder, view.name, range);
        if (drawn.empty() || without_renderer(drawn) != without_renderer(stamp)) return false;
        for (int k = range.first; k <= range.last; ++k) {
            if (!std::filesystem::exists(folder.picture(view.name, k))) return false;
        }
        return true;
    });
}

int pictures_missing(const RunFolder& folder, const std::string& view,
                     const std::vector<FrameRange>& missing) {
    int count = 0;
    for (const FrameRange& range : missing) {
        for (int k = range.first; k <= range.last; ++k)
            count += !std::filesystem::exists(folder.picture(view, k));
    }
    return count;
}

}  // namespace

std::vector<FrameRange> cut_frames(int first, int last, int parts) {
    const int frames = last - first + 1;
    if (parts == 0) parts = std::clamp(frames / worth_a_task, 1, most_tasks);
    parts = std::min(parts, frames);
    std::vector<FrameRange> ranges;
    for (int k = 0; k < parts; ++k) {
        const auto start = [&](int part) {
            return first + static_cast<int>(static_cast<long>(frames) * part / parts);
        };
        ranges.push_back({start(k), start(k + 1) - 1});
    }
    return ranges;
}

ClusterWork range_work(const std::vector<FrameRange>& ranges, const Scene& scene, const RunFolder& cached,
                       const RunFolder& folder, const ClipOptions& clip) {
    if (!clip.keep_pictures)
        throw UsageError(
            "--slurm draws pictures and makes the video of them: it does not go with --no-pictures");
    for (int k = clip.first; k <= clip.last; ++k) {
        if (!std::filesystem::exists(cached.record(k)))
            throw FolderError(fmt::format("'{}' holds no frame {} yet", cached.root.string(), k));
    }
    const std::string stamp = picture_stamp(scene, clip, "");
    ClusterWork work;
    work.name = "render";
    work.what =
        fmt::format("range K of {}, counted from 0, of frames {}-{}", ranges.size(), clip.first, clip.last);
    work.results = folder.root;
    std::vector<FrameRange> missing;
    for (std::size_t k = 0; k < ranges.size(); ++k) {
        if (is_drawn(folder, clip, stamp, ranges[k])) continue;
        work.missing.push_back(static_cast<int>(k));
        missing.push_back(ranges[k]);
    }
    // What was drawn otherwise is not to be taken for this clip's.
    work.prepare = [folder, views = clip.views, stamp, ranges] {
        std::filesystem::create_directories(folder.frames());
        for (const ClipView& view : views) keep_ranges(folder, view.name, stamp, ranges);
    };
    work.total = clip.last - clip.first + 1;
    work.done = [folder, view = clip.views.back().name, total = work.total, missing] {
        return total - pictures_missing(folder, view, missing);
    };
    return work;
}

void narrow_to_range(const FrameRange& range, ClipOptions& clip) {
    clip.first = range.first;
    clip.last = range.last;
    clip.video_ending.clear();
    clip.reuse_pictures = true;
    clip.shares_folder = true;
}

void gather_ranges(const std::vector<FrameRange>& ranges, const Scene& scene, const RunFolder& folder,
                   ClipOptions& clip) {
    const std::string stamp = picture_stamp(scene, clip, "");
    std::string missing;
    std::map<std::string, std::string> drawn_by;  // renderer → the first range that it drew
    for (std::size_t k = 0; k < ranges.size(); ++k) {
        const std::string name = fmt::format("frames {}-{}", ranges[k].first, ranges[k].last);
        if (!is_drawn(folder, clip, stamp, ranges[k])) {
            missing +=
                fmt::format("\n  {}: {}", name, why_missing(folder.root, "render", static_cast<int>(k)));
            continue;
        }
        for (const ClipView& view : clip.views)
            drawn_by.emplace(renderer_in(stamp_of_range(folder, view.name, ranges[k])), name);
    }
    if (!missing.empty()) {
        throw MissingPieces(
            fmt::format("no video is made of '{}' while frames are missing:{}\nthe same command "
                        "sends them again and keeps the rest",
                        folder.root.string(), missing));
    }
    if (drawn_by.size() > 1) {
        std::string who;
        for (const auto& [renderer, name] : drawn_by) who += fmt::format("\n  {}: {}", name, renderer);
        throw FolderError(
            fmt::format("not every frame was drawn by the same renderer, and they would flicker:{}\n"
                        "--device software draws the same on every node, as does a choice of nodes "
                        "(--partition, --sbatch=--constraint=...)",
                        who));
    }
    clip.reuse_pictures = true;
    clip.vouched = true;
}

}  // namespace unravel::tool
