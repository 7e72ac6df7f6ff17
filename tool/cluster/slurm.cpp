#include "tool/cluster/slurm.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace unravel::tool {

namespace {

struct Answer {
    int status = 0;
    std::string text;  // what it printed, errors included
};

Answer ask(std::vector<std::string> words) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    const int failed = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    Answer answer;
    if (failed == 0) {
        std::array<char, 4096> buffer{};
        for (ssize_t got; (got = ::read(ends[0], buffer.data(), buffer.size())) != 0;) {
            if (got > 0) answer.text.append(buffer.data(), static_cast<std::size_t>(got));
            if (got < 0 && errno != EINTR) break;
        }
        while (::waitpid(child, &answer.status, 0) < 0 && errno == EINTR) {
        }
    }
    ::close(ends[0]);
    if (failed == ENOENT) {
        throw std::runtime_error(fmt::format(
            "'{}' is not on this machine: --slurm needs Slurm's own commands (Debian: slurm-client); "
            "--dry-run prints the job scripts without",
            words[0]));
    }
    if (failed != 0) throw std::runtime_error(fmt::format("'{}': {}", words[0], std::strerror(failed)));
    return answer;
}

std::string must(std::vector<std::string> words) {
    const std::string name = words[0];
    Answer answer = ask(std::move(words));
    if (answer.status != 0) throw std::runtime_error(fmt::format("{} says: {}", name, answer.text));
    return std::move(answer.text);
}

// The number between two texts of an answer.
std::optional<int> number_after(const std::string& text, const std::string& before) {
    const std::size_t at = text.find(before);
    if (at == text.npos) return {};
    int value = 0;
    const char* start = text.data() + at + before.size();
    if (std::from_chars(start, text.data() + text.size(), value).ec != std::errc()) return {};
    return value;
}

}  // namespace

std::string slurm_submit(const std::string& script, const std::string& after, bool any) {
    std::vector<std::string> words{"sbatch", "--parsable"};
    if (!after.empty()) {
        words.push_back(fmt::format("--dependency={}:{}", any ? "afterany" : "afterok", after));
        words.emplace_back("--kill-on-invalid-dep=yes");
    }
    words.push_back(script);
    if (!after.empty()) words.push_back(after);
    // NUMBER or NUMBER;CLUSTER, after what the site has to say
    std::string text = must(std::move(words));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    text.erase(0, text.rfind('\n') + 1);
    return text.substr(0, text.find(';'));
}

std::vector<QueuedTask> slurm_queue(const std::string& comment) {
    std::vector<QueuedTask> tasks;
    std::string text = must({"squeue", "--me", "--noheader", "--array", "--format=%F|%j|%T|%r|%k"});
    for (std::size_t at = 0, end; (end = text.find('\n', at)) != text.npos; at = end + 1) {
        const std::string line = text.substr(at, end - at);
        std::array<std::string, 5> cells;
        std::size_t from = 0;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::size_t to = k + 1 < cells.size() ? line.find('|', from) : line.npos;
            cells[k] = line.substr(from, to == line.npos ? to : to - from);
            if (to == line.npos) break;
            from = to + 1;
        }
        if (cells[4] != comment) continue;
        tasks.push_back({cells[0], cells[1], cells[2] != "PENDING", cells[3]});
    }
    return tasks;
}

std::optional<int> slurm_exit_code(const std::string& job) {
    const Answer shown = ask({"scontrol", "--oneliner", "show", "job", job});
    if (shown.status == 0) {
        if (shown.text.find("JobState=COMPLETED") != shown.text.npos) return 0;
        if (const auto code = number_after(shown.text, "ExitCode=")) return *code == 0 ? 1 : *code;
    }
    // Gone from the controller's memory; the accounts, where they are kept, remember.
    const Answer kept =
        ask({"sacct", "--noheader", "--allocations", "--parsable2", "--jobs", job, "--format=ExitCode"});
    return kept.status == 0 ? number_after("\n" + kept.text, "\n") : std::nullopt;
}

}  // namespace unravel::tool
