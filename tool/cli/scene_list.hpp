#pragma once

#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/cli/run_options.hpp"

namespace unravel::tool {

/// Does a command (run, simulate) that is for one scene for every scene named: one after another, as tasks of
/// a cluster, or only the one that --point says. A scene that fails is named, and the others are done.
/// Several scenes with -o DIR go to DIR/<scene name>. Returns the first exit code that is not 0. Throws
/// SceneError, UsageError, FolderError, OutputError.
int for_each_scene(const RunOptions& options, RunOne one);

/// How a run was asked for, as far as that decides what it leaves: run.json keeps it, so that a run that is
/// complete can be told from one with other pictures.
std::vector<std::string> command_of_run(const RunOptions& options);

}  // namespace unravel::tool
