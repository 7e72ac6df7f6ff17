#include "tool/base/interrupt.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <initializer_list>

namespace unravel::tool {

namespace {

// A signal handler can reach nothing but a global; it runs on any thread, and others read.
std::atomic<int> received{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int number) {
    // Whoever was interrupted may be about to ask what went wrong with it.
    const int error = errno;
    if (received.exchange(number) != 0) {
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
    errno = error;
}

}  // namespace

InterruptWatch::InterruptWatch() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
}

bool InterruptWatch::requested() {
    return received != 0;
}
int InterruptWatch::signal() {
    return received;
}

}  // namespace unravel::tool
