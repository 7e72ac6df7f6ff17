#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Slurm's own commands, called as a user would call them. All throw std::runtime_error with the command's
/// words where it fails or is not there.

/// Puts a script into the queue, to start once the jobs `after` have ended: with success, or (`any`) however.
/// Their number is the script's argument. Returns the job's number.
std::string slurm_submit(const std::string& script, const std::string& after = {}, bool any = true);

/// A job, or task of an array, that waits or runs.
struct QueuedTask {
    std::string job;   ///< number of the job or array
    std::string name;  ///< of the job
    bool running = false;
    std::string reason;  ///< why it waits
};

/// Mine that carry a comment.
std::vector<QueuedTask> slurm_queue(const std::string& comment);

/// How a job that has left the queue ended; nothing where the cluster has forgotten it.
std::optional<int> slurm_exit_code(const std::string& job);

}  // namespace unravel::tool
