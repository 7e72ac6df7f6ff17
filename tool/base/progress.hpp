#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Frame (or what else is counted) k of n, time for each and time left: one line that is rewritten on a
/// terminal, a plain line now and then elsewhere. Goes to standard error. The rate is that of frames done by
/// this process, so it is right after a resume.
class Progress {
public:
    Progress(std::string what, int total, bool quiet, std::string unit = "frame");
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `done` frames are finished in all; `free` ones of them cost this process nothing. `left` is the time
    /// still to go [s], where that is known better than by what each took so far.
    void show(int done, int free, std::optional<double> left = {});
    /// Ends the line. Called once, when all is done or will not be.
    void finish();

private:
    using Clock = std::chrono::steady_clock;
    std::string what_, unit_;
    int total_;
    bool quiet_, terminal_, open_ = false;
    Clock::time_point start_ = Clock::now(), shown_{};
};

/// "1 h 02 min", "3 min 05 s", "12 s".
std::string duration_text(double seconds);

}  // namespace unravel::tool
