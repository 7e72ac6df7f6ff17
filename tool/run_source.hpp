#pragma once

#include <tbb/task_arena.h>

#include <chrono>
#include <optional>
#include <vector>

#include "sim/simulate.hpp"
#include "tool/run_folder.hpp"

namespace unravel {

/// The frames of a run, from its cache as far as that goes, then simulated and cached. The same frames come
/// out either way, bit for bit.
class RunSource {
public:
    /// `cached` frames are in the folder already; the simulation starts from its scene's beginning or is put
    /// where the last of them left off. Steps use `threads` threads and no others.
    RunSource(const Scene& scene, const RunFolder& folder, std::uint64_t scene_hash, Simulation& simulation,
              int cached, int threads);

    /// The next frame; nothing after the last, or when a stop was asked for. Throws what simulation and disk
    /// throw.
    std::optional<FrameRecord> next();

    /// Writes stats.csv with all rows so far.
    void write_stats() const;

    const std::vector<StepReport>& reports() const { return reports_; }
    const std::vector<std::uint64_t>& hashes() const { return hashes_; }
    double seconds() const { return seconds_; }  ///< spent in simulating
    int cached() const { return cached_; }

private:
    FrameRecord simulate();

    const Scene& scene_;
    const RunFolder& folder_;
    std::uint64_t scene_hash_;
    Simulation& simulation_;
    int cached_, frame_ = 0;
    tbb::task_arena arena_;
    std::string earlier_stats_;  // of the run that is gone on with: the cache holds no times
    std::vector<StepReport> reports_;
    std::vector<std::uint64_t> hashes_;  // one per frame
    double seconds_ = 0;
    std::chrono::steady_clock::time_point stats_written_ = std::chrono::steady_clock::now();
};

}  // namespace unravel
