#include "tool/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace unravel {

namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t received = 0;

extern "C" void on_signal(int number) {
    if (received != 0) {
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
    received = number;
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

}  // namespace unravel
