#include "tool/base/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace unravel::tool {

std::string duration_text(double seconds) {
    const long s = std::lround(std::max(seconds, 0.0));
    if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
    if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
    return fmt::format("{} s", s);
}

Progress::Progress(std::string what, int total, bool quiet, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    finish();
}

void Progress::show(int done, int free, std::optional<double> left) {
    if (quiet_) return;
    const auto now = Clock::now();
    const bool last = done == total_;
    const double since = std::chrono::duration<double>(now - shown_).count();
    if (shown_ != Clock::time_point{} && since < (terminal_ ? 0.1 : 5.0) && !last) return;
    shown_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const int worked = done - free;
    std::string line = fmt::format("{}: {} {} of {}", what_, unit_, done, total_);
    if (left && !last) {
        line += fmt::format(", {} left", duration_text(*left));
    } else if (worked > 0) {
        const double each = elapsed / worked;
        line += fmt::format(
            ", {:.0f} ms per {}, {}", 1e3 * each, unit_,
            last ? duration_text(elapsed) + " in all" : duration_text(each * (total_ - done)) + " left");
    }
    // Nobody listening (a closed pipe) is no reason to stop a run, so what could be thrown here is not asked
    // for.
    line = terminal_ ? "\r\x1b[K" + line : line + "\n";
    std::fputs(line.c_str(), stderr);
    open_ = terminal_;
    std::fflush(stderr);
}

void Progress::finish() {
    if (open_) std::fputs("\n", stderr);
    open_ = false;
}

}  // namespace unravel::tool
