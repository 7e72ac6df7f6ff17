#include "tool/cluster/cluster.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "base/file_errors.hpp"
#include "base/whole_file.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/program.hpp"
#include "tool/base/progress.hpp"
#include "tool/cluster/job_script.hpp"
#include "tool/cluster/slurm.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_log = std::size_t{64} << 20;

std::vector<JobScript> scripts_of(const ClusterWork& work) {
    std::vector<std::string> words = piece_words(work.words);
    words.insert(words.end(), work.more.begin(), work.more.end());
    std::string command = shell_quoted(words);
    if (work.threads) command += " --threads \"${SLURM_CPUS_PER_TASK:-1}\"";
    if (work.undivided) return {{work.name, work.what, command, {}, work.alone}};
    std::vector<JobScript> scripts;
    if (!work.before.empty() && !work.missing.empty()) {
        scripts.push_back(
            {work.name + "_before", "What all tasks need.", command + " " + work.before, {}, false});
    }
    if (!work.missing.empty()) {
        scripts.push_back({work.name, fmt::format("Task K: {}.", work.what),
                           command + " --point \"$SLURM_ARRAY_TASK_ID\"", work.missing, work.alone});
    }
    scripts.push_back(
        {work.name + "_collect",
         "After all tasks, whether they succeeded or not: what they left is put together, what is "
         "missing is named.",
         command + " --collect",
         {},
         false,
         true});
    return scripts;
}

// Numbers of the work's jobs that wait or run, in the order in which they were sent.
std::vector<std::string> jobs_of(const std::vector<QueuedTask>& queue) {
    std::vector<std::string> jobs;
    for (const QueuedTask& task : queue) {
        if (std::find(jobs.begin(), jobs.end(), task.job) == jobs.end()) jobs.push_back(task.job);
    }
    std::sort(jobs.begin(), jobs.end(), [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    return jobs;
}

// Why nothing runs, once it has changed.
std::string waiting_for(const std::vector<QueuedTask>& queue) {
    std::set<std::string> reasons;
    for (const QueuedTask& task : queue) {
        if (task.running) return {};
        if (task.reason != "Dependency" && task.reason != "None") reasons.insert(task.reason);
    }
    return fmt::format("{}", fmt::join(reasons, ", "));
}

// Until no job of the work is left in the queue. False: the user would not wait.
bool wait_for_end(const OutputOptions& output, const ClusterWork& work, const std::string& comment) {
    using namespace std::chrono_literals;
    constexpr auto blink = 100ms, longest = 10000ms;
    auto period = 500ms;
    const int before = work.done();
    std::string told;
    Progress progress(work.name, work.total, output.quiet, work.unit);
    for (;;) {
        const std::vector<QueuedTask> queue = slurm_queue(comment);
        progress.show(work.done(), before);
        if (queue.empty()) break;
        if (const std::string why = waiting_for(queue); !why.empty() && why != told && !output.quiet) {
            progress.finish();
            fmt::print(stderr, "{}: waits in the queue: {}\n", work.name, why);
            told = why;
        }
        for (auto slept = 0ms; slept < period; slept += blink) {
            std::this_thread::sleep_for(blink);
            if (InterruptWatch::requested()) return false;
        }
        period = std::min(period + period / 2, std::chrono::milliseconds(longest));
    }
    progress.finish();
    return true;
}

int wait_and_tell(const OutputOptions& output, const ClusterWork& work,
                  const std::vector<std::string>& jobs) {
    const InterruptWatch watch;
    const fs::path results = fs::absolute(work.results).lexically_normal();
    if (!wait_for_end(output, work, job_comment(results))) {
        fmt::print(stderr,
                   "the jobs go on; `scancel {}` ends those that wait and sends those that run back "
                   "to wait\n",
                   fmt::join(jobs, " "));
        return InterruptWatch::exit_code();
    }
    const fs::path log = job_log(results, work.undivided ? work.name : work.name + "_collect");
    if (fs::exists(log)) fmt::print("{}", read_whole_text(log, largest_log));
    const std::optional<int> code = slurm_exit_code(jobs.back());
    if (!code) throw InputError(log, "the cluster has forgotten how its job ended");
    return *code;
}

void tell(const OutputOptions& output, const ClusterWork& work, const std::vector<JobScript>& scripts,
          const std::vector<std::string>& jobs) {
    if (output.json) {
        nlohmann::ordered_json json{{"results", work.results.string()}, {"pieces", work.missing}};
        for (std::size_t k = 0; k < jobs.size(); ++k) json["jobs"][scripts[k].name] = jobs[k];
        fmt::print("{}\n", json.dump(2));
        return;
    }
    if (output.quiet) return;
    for (std::size_t k = 0; k < jobs.size(); ++k) {
        const std::size_t tasks = scripts[k].tasks.size();
        fmt::print("job {}  {}{}\n", jobs[k], scripts[k].name,
                   tasks > 0 ? fmt::format(", {} task{}", tasks, tasks == 1 ? "" : "s") : "");
    }
    fmt::print("  {}\n", job_folder(work.results).string());
    std::fflush(stdout);
}

}  // namespace

std::vector<std::string> words_without(const std::vector<std::string>& words,
                                       const std::vector<std::string>& flags,
                                       const std::vector<std::string>& valued) {
    const auto among = [](const std::vector<std::string>& list, const std::string& word) {
        return std::find(list.begin(), list.end(), word) != list.end();
    };
    std::vector<std::string> kept;
    for (std::size_t k = 0; k < words.size(); ++k) {
        const std::string& word = words[k];
        if (among(flags, word)) continue;
        if (among(valued, word)) {
            ++k;
            continue;
        }
        const bool joined = std::any_of(valued.begin(), valued.end(), [&](const std::string& option) {
            // --option=value, -ovalue
            return option.starts_with("--") ? word.starts_with(option + "=") : word.starts_with(option);
        });
        if (!joined) kept.push_back(word);
    }
    return kept;
}

std::vector<std::string> piece_words(const std::vector<std::string>& words) {
    return words_without(
        words, {"--slurm", "--wait", "--dry-run", "--force", "--resume", "--collect", "--reference"},
        {"--partition", "--time", "--cpus", "--array-limit", "--sbatch", "--point"});
}

std::string why_missing(const fs::path& results, const std::string& name, int piece) {
    const fs::path log = job_log(results, name, piece);
    if (!fs::exists(log)) return "was not done";
    std::string text = read_whole_text(log, largest_log);
    std::string last, said;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string line = text.substr(at, end - at);
        at = end + 1;
        line.erase(0, line.rfind('\r') + 1);
        if (line.empty()) continue;
        if (line.starts_with("unravel: ")) said = line.substr(9);
        last = std::move(line);
    }
    return fmt::format("{} ({})", said.empty() ? last.empty() ? "was killed" : last : said, log.string());
}

int do_on_cluster(const ClusterOptions& options, const OutputOptions& output, const ClusterWork& work) {
    const fs::path results = fs::absolute(work.results).lexically_normal();
    const std::vector<JobScript> scripts = scripts_of(work);
    const auto text_of = [&](const JobScript& script) {
        return job_script_text(script, program_file(), results, fs::current_path(), options);
    };
    if (options.dry_run) {
        for (const JobScript& script : scripts)
            fmt::print("# ---- {}\n{}\n", (job_folder(results) / (script.name + ".sh")).string(),
                       text_of(script));
        return exit_done;
    }
    if (const std::vector<std::string> jobs = jobs_of(slurm_queue(job_comment(results))); !jobs.empty()) {
        const fs::path last = job_folder(results) / (scripts.back().name + ".sh");
        const bool same = fs::exists(last) && read_whole_text(last, largest_log) == text_of(scripts.back());
        if (same && options.wait) return wait_and_tell(output, work, jobs);
        throw FolderError(fmt::format("'{}' is at work on the cluster already{}: {}`scancel {}` ends it",
                                      work.results.string(), same ? "" : ", in another way",
                                      same ? "--wait shows how far it is, " : "", fmt::join(jobs, " ")));
    }
    if (work.prepare) work.prepare();
    std::error_code error;
    fs::create_directories(job_folder(results), error);
    if (error) throw OutputError(job_folder(results), error.value());
    std::vector<std::string> jobs;
    for (std::size_t k = 0; k < scripts.size(); ++k) {
        const fs::path file = job_folder(results) / (scripts[k].name + ".sh");
        write_whole_file(file, text_of(scripts[k]));
        // Logs grow while a task is queued again; those of an earlier sending are no news.
        fs::remove(job_log(results, scripts[k].name), error);
        for (const int task : scripts[k].tasks) fs::remove(job_log(results, scripts[k].name, task), error);
        const bool collects = k + 1 == scripts.size() && !work.undivided;
        jobs.push_back(slurm_submit(file.string(), jobs.empty() ? "" : jobs.back(), collects));
    }
    tell(output, work, scripts, jobs);
    return options.wait ? wait_and_tell(output, work, jobs) : exit_done;
}

}  // namespace unravel::tool
