#include "tool/run/run_source.hpp"

#include <algorithm>

#include "base/whole_file.hpp"
#include "sim/run/stats.hpp"
#include "tool/base/interrupt.hpp"

namespace unravel::tool {

namespace {

// stats.csv is written anew this often, so that it can be looked at while the run goes on.
constexpr std::chrono::seconds stats_period{5};

// As many steps are turned into text at a time.
constexpr std::size_t rows_at_once = 256;

}  // namespace

RunSource::RunSource(const Scene& scene, const RunFolder& folder, std::uint64_t scene_hash,
                     Simulation& simulation, int cached, int threads)
    : scene_(scene),
      folder_(folder),
      scene_hash_(scene_hash),
      simulation_(simulation),
      cached_(cached),
      arena_(threads),
      reports_(folder.root) {
    simulation.options.solve.stop = InterruptWatch::flag();
}

std::optional<FrameRecord> RunSource::next() {
    if (frame_ >= scene_.clip.frames() || InterruptWatch::requested()) return std::nullopt;
    FrameRecord record;
    std::optional<FrameRecord> simulated;
    if (frame_ < cached_) {
        record = read_record(folder_.record(frame_), scene_hash_, simulation_.model.size(),
                             simulation_.model.springs.size());
        if (frame_ + 1 == cached_) restore(simulation_, record);
    } else {
        StageTimer timer;
        try {
            arena_.execute([&] { simulated = simulate(); });
        } catch (const Stopped&) {
            return std::nullopt;
        }
        timer.lap(seconds_);
        if (!simulated) return std::nullopt;
        record = std::move(*simulated);
        write_record(folder_.record(frame_), scene_hash_, record);
    }
    ++frame_;
    reports_.append(record.reports);
    hashes_.push_back(state_hash(record.state));
    if (frame_ == cached_) take_earlier_times();
    if (std::chrono::steady_clock::now() - stats_written_ > stats_period) {
        write_stats();
        stats_written_ = std::chrono::steady_clock::now();
    }
    return record;
}

// Nothing where it is to stop before frame 0.
std::optional<FrameRecord> RunSource::simulate() {
    if (!settle(simulation_, [] { return !InterruptWatch::requested(); })) return std::nullopt;
    return frame_ == 0 ? present_record(simulation_) : next_record(simulation_);
}

// Of the run that is gone on with: the cache holds no times.
void RunSource::take_earlier_times() {
    if (!std::filesystem::exists(folder_.stats())) return;
    std::vector<StepReport> reports = reports_.read_all();
    take_times(read_whole_text(folder_.stats(), largest_stats), reports);
    reports_.replace(reports);
}

void RunSource::write_stats() const {
    WholeFile file(folder_.stats());
    file.write(stats_header());
    for (std::size_t first = 0; first < reports_.size(); first += rows_at_once)
        file.write(stats_rows(reports_.read(first, std::min(rows_at_once, reports_.size() - first))));
    file.commit();
}

}  // namespace unravel::tool
