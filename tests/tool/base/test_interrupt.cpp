#include "tool/base/interrupt.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>

using namespace unravel;
using namespace unravel::tool;

namespace {

// What becomes of a process that does this: as waitpid() tells it. Handlers are a process's own for good.
template <typename F>
int fate_of(const F& work) {
    const pid_t child = fork();
    if (child == 0) _exit(work());
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return status;
}

}  // namespace

TEST_CASE("a first signal asks for a stop and a second ends the program") {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        INFO(strsignal(number));
        const int asked = fate_of([&] {
            const InterruptWatch watch;
            std::raise(number);
            return InterruptWatch::requested() && is_asked_to_stop(InterruptWatch::flag())
                       ? InterruptWatch::exit_code()
                       : 1;
        });
        REQUIRE(WIFEXITED(asked));
        CHECK(WEXITSTATUS(asked) == 128 + number);
        for (const int second : {SIGINT, SIGTERM, SIGHUP}) {
            const int ended = fate_of([&] {
                const InterruptWatch watch;
                std::raise(number);
                std::raise(second);
                return 0;
            });
            REQUIRE(WIFSIGNALED(ended));
            CHECK(WTERMSIG(ended) == second);
        }
    }
}

TEST_CASE("a signal that the caller ignores stays ignored") {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        INFO(strsignal(number));
        const int fate = fate_of([&] {
            std::signal(number, SIG_IGN);
            const InterruptWatch watch;
            std::raise(number);
            std::raise(number);
            return InterruptWatch::requested() ? 1 : 0;
        });
        REQUIRE(WIFEXITED(fate));
        CHECK(WEXITSTATUS(fate) == 0);
    }
}
