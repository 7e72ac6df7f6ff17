#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/cluster/cluster_options.hpp"

namespace unravel::tool {

/// One batch script for Slurm: a single job, or an array of tasks that differ in their index only.
struct JobScript {
    std::string name;     ///< of the job, the script and its logs: "render"
    std::string what;     ///< for people, in a sentence
    std::string command;  ///< shell text that follows the tool's path; a task finds its index in it by name
    std::vector<int> tasks;  ///< indices, ascending; empty: a single job
    bool alone = false;      ///< is timed: nothing else is to run on its node
    bool collects =
        false;  ///< its argument is the job that it has to come after, however often that is queued
};

/// The folder for a work's scripts and logs.
std::filesystem::path job_folder(const std::filesystem::path& results);

/// Where a job, or a task of it, leaves what it prints. `task` −1: a single job.
std::filesystem::path job_log(const std::filesystem::path& results, const std::string& name, int task = -1);

/// What tells a work's jobs from others in the queue.
std::string job_comment(const std::filesystem::path& results);

/// The script's text, to be read and kept.
///   tool     path under which every node finds the program
///   results  absolute folder of the work's results, on a disk that all nodes share
///   place    absolute folder in which the command is to run
std::string job_script_text(const JobScript& script, const std::filesystem::path& tool,
                            const std::filesystem::path& results, const std::filesystem::path& place,
                            const ClusterOptions& options);

/// "0-3,7,9-10" for ascending numbers, as sbatch takes them.
std::string index_ranges(const std::vector<int>& ascending);

/// A word that a POSIX shell reads as it is.
std::string shell_quoted(const std::string& word);
std::string shell_quoted(const std::vector<std::string>& words);

}  // namespace unravel::tool
