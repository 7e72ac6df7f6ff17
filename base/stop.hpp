#pragma once

#include <atomic>
#include <exception>

namespace unravel {

/// Where somebody outside, such as a signal's handler, asks for a stop: anything but 0. Null: nobody does.
using StopFlag = const std::atomic<int>*;

/// A step was given up because a stop was asked for. What it has changed is not to be gone on with.
class Stopped : public std::exception {
public:
    const char* what() const noexcept override { return "stopped in the middle of a step"; }
};

inline bool is_asked_to_stop(StopFlag stop) {
    return stop && stop->load(std::memory_order_relaxed) != 0;
}

/// Called within whatever may take long: every step, substep and iteration. Throws Stopped.
inline void heed(StopFlag stop) {
    if (is_asked_to_stop(stop)) throw Stopped();
}

}  // namespace unravel
