#include "tool/run_source.hpp"

#include "base/whole_file.hpp"
#include "sim/stats.hpp"
#include "tool/interrupt.hpp"

namespace unravel {

namespace {

// stats.csv is written anew this often, so that it can be looked at while the run goes on.
constexpr std::chrono::seconds stats_period{5};

}  // namespace

RunSource::RunSource(const Scene& scene, const RunFolder& folder, std::uint64_t scene_hash,
                     Simulation& simulation, int cached, int threads)
    : scene_(scene),
      folder_(folder),
      scene_hash_(scene_hash),
      simulation_(simulation),
      cached_(cached),
      arena_(threads) {
    if (cached > 0 && std::filesystem::exists(folder.stats())) {
        earlier_stats_ = read_whole_text(folder.stats(), largest_stats);
    }
}

std::optional<FrameRecord> RunSource::next() {
    if (frame_ >= scene_.clip.frames() || InterruptWatch::requested()) return std::nullopt;
    FrameRecord record;
    if (frame_ < cached_) {
        record = read_record(folder_.record(frame_), scene_hash_, simulation_.model.size(),
                             simulation_.model.springs.size());
        if (frame_ + 1 == cached_) restore(simulation_, record);
    } else {
        StageTimer timer;
        arena_.execute([&] { record = simulate(); });
        timer.lap(seconds_);
        write_record(folder_.record(frame_), scene_hash_, record);
    }
    ++frame_;
    reports_.insert(reports_.end(), record.reports.begin(), record.reports.end());
    hashes_.push_back(state_hash(record.state));
    if (frame_ == cached_) take_times(earlier_stats_, reports_);
    if (std::chrono::steady_clock::now() - stats_written_ > stats_period) {
        write_stats();
        stats_written_ = std::chrono::steady_clock::now();
    }
    return record;
}

FrameRecord RunSource::simulate() {
    return frame_ == 0 ? present_record(simulation_) : next_record(simulation_);
}

void RunSource::write_stats() const {
    write_whole_file(folder_.stats(), stats_csv(reports_));
}

}  // namespace unravel
