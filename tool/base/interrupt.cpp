#include "tool/base/interrupt.hpp"

#include <unistd.h>
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
    int none = 0;
    if (received.compare_exchange_strong(none, number)) {
        constexpr char words[] =
            "\nunravel: stopping, and keeping what is done; a second signal ends it at once\n";
        if (isatty(STDERR_FILENO) != 0) static_cast<void>(!write(STDERR_FILENO, words, sizeof words - 1));
    } else {
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
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction inherited {};
        sigaction(number, nullptr, &inherited);
        if (inherited.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);
}

bool InterruptWatch::requested() {
    return received != 0;
}
StopFlag InterruptWatch::flag() {
    return &received;
}
int InterruptWatch::exit_code() {
    return 128 + received;
}

}  // namespace unravel::tool
