#include "tool/cluster/job_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view harmless =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%^";

// How a task ends. The tool runs beside the shell, which outlives it where the tool alone is killed.
constexpr std::string_view how_it_ends = R"(
# A task that is killed, by scancel too, or whose time is up (Slurm says so a minute ahead), goes back into the queue
# and goes on from where it stopped; scancel while it waits there ends it. One that fails for a reason of its own has
# failed.
work=$!
trap 'kill -TERM "$work"' USR1 TERM
wait "$work"; status=$?
while kill -0 "$work" 2>/dev/null; do wait "$work"; status=$?; done
if ((status > 128 && ${SLURM_RESTART_COUNT:-0} < 10)); then scontrol requeue "$SLURM_JOB_ID"; fi
exit "$status"
)";

// Slurm lets a job go that waits for others as soon as all of those have ended, and those that were killed
// have for a moment: until they are back in the queue. They are seen there from before they end.
constexpr std::string_view comes_last = R"sh(
# A task that was killed is back in the queue by now. While any of job $1 is there, this one goes back too.
if [[ -n "${1-}" && -n "$(squeue --noheader --jobs="$1" 2>/dev/null)" ]]; then
    scontrol requeue "$SLURM_JOB_ID"
    exit
fi
)sh";

// A directive's value: sbatch takes quotes off like a shell does, and knows no other escape.
std::string directive(const std::string& option, const std::string& value) {
    const bool plain = value.find_first_of(" \t'#") == value.npos;
    return fmt::format("#SBATCH --{}={}\n", option, plain ? value : '"' + value + '"');
}

}  // namespace

fs::path job_folder(const fs::path& results) {
    return results / "slurm";
}

fs::path job_log(const fs::path& results, const std::string& name, int task) {
    return job_folder(results) / (task < 0 ? name + ".log" : fmt::format("{}_{}.log", name, task));
}

std::string job_comment(const fs::path& results) {
    return "unravel " + results.string();
}

std::string index_ranges(const std::vector<int>& ascending) {
    std::string text;
    for (std::size_t k = 0; k < ascending.size();) {
        std::size_t end = k + 1;
        while (end < ascending.size() && ascending[end] == ascending[end - 1] + 1) ++end;
        text += fmt::format("{}{}", text.empty() ? "" : ",", ascending[k]);
        if (end - k > 1) text += fmt::format("-{}", ascending[end - 1]);
        k = end;
    }
    return text;
}

std::string shell_quoted(const std::string& word) {
    if (!word.empty() && word.find_first_not_of(harmless) == word.npos) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string shell_quoted(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + shell_quoted(word);
    return text;
}

std::string job_script_text(const JobScript& script, const fs::path& tool, const fs::path& results,
                            const fs::path& place, const ClusterOptions& options) {
    const bool array = !script.tasks.empty();
    std::string text = "#!/bin/bash\n";
    text += directive("job-name", script.name);
    text += directive("comment", job_comment(results));
    text += directive("chdir", place.string());
    text +=
        directive("output", (job_folder(results) / (script.name + (array ? "_%a" : "") + ".log")).string());
    text += "#SBATCH --open-mode=append --requeue --signal=B:USR1@60\n";
    if (array) {
        text +=
            directive("array", index_ranges(script.tasks) +
                                   (options.array_limit > 0 ? fmt::format("%{}", options.array_limit) : ""));
    }
    if (!options.partition.empty()) text += directive("partition", options.partition);
    if (!options.time.empty()) text += directive("time", options.time);
    if (options.cpus > 0) text += directive("cpus-per-task", std::to_string(options.cpus));
    if (script.alone) text += "#SBATCH --exclusive\n";
    for (const std::string& other : options.sbatch) text += "#SBATCH " + other + "\n";
    text += "\n# " + script.what + "\n";
    if (array) {
        text +=
            "# Each task writes files of its own, whole or not at all, and takes over those that lie there: "
            "it may\n"
            "# be killed at any time and run again. By hand: sbatch this file; some tasks only: sbatch "
            "--array=3,5.\n";
    }
    if (script.collects) text += comes_last;
    if (!script.alone)
        text += "export LP_NUM_THREADS=\"${SLURM_CPUS_PER_TASK:-1}\"  # of the software renderer\n";
    text += fmt::format("{} {} &\n", shell_quoted(tool.string()), script.command);
    return text + std::string(how_it_ends);
}

}  // namespace unravel::tool
