#pragma once

#include <string>
#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// --slurm and what goes with it: work sent to a cluster instead of done here.
struct ClusterOptions {
    bool submit = false;   ///< --slurm
    bool wait = false;     ///< --wait: show progress until all is done
    bool dry_run = false;  ///< --dry-run: print the job scripts, change nothing
    std::string partition, time;
    int cpus = 0;                     ///< per task; 0: as the cluster has it
    int array_limit = 0;              ///< tasks at the same time; 0: as many as the cluster gives
    std::vector<std::string> sbatch;  ///< any other of sbatch's options, as they are
};

}  // namespace unravel::tool
