#pragma once

#include <tbb/task_arena.h>

#include <chrono>
#include <optional>
#include <vector>

#include "base/disk_buffer.hpp"
#include "sim/run/simulate.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

/// The frames of a run, from its cache as far as that goes, then simulated and cached. The same frames come
/// out either way, bit for bit.
class RunSource {
public:
    /// `cached` frames are in the folder already; the simulation starts from its scene's beginning or is put
    /// where the last of them left off. Steps use `threads` threads and no others.
    RunSource(const Scene& scene, const RunFolder& folder, std::uint64_t scene_hash, Simulation& simulation,
              int cached, int threads);

    /// The next frame; nothing after the last, or when a stop was asked for, also in the middle of a step.
    /// Throws what simulation and disk throw.
    std::optional<FrameRecord> next();

    /// Writes stats.csv with all rows so far.
    void write_stats() const;

    /// Of all steps so far, read back from where they were put aside: a run holds no more the longer it is.
    std::vector<StepReport> reports() const { return reports_.read_all(); }
    const std::vector<std::uint64_t>& hashes() const { return hashes_; }
    double seconds() const { return seconds_; }  ///< spent in simulating
    int cached() const { return cached_; }

private:
    std::optional<FrameRecord> simulate();
    void take_earlier_times();

    const Scene& scene_;
    const RunFolder& folder_;
    std::uint64_t scene_hash_;
    Simulation& simulation_;
    int cached_, frame_ = 0;
    tbb::task_arena arena_;
    DiskList<StepReport> reports_;
    std::vector<std::uint64_t> hashes_;  // one per frame
    double seconds_ = 0;
    std::chrono::steady_clock::time_point stats_written_ = std::chrono::steady_clock::now();
};

}  // namespace unravel::tool
