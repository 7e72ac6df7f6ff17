#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tool/base/output.hpp"
#include "tool/cluster/cluster_options.hpp"

namespace unravel::tool {

// Options that several commands have, each described once.

void add_output_options(CLI::App& command, OutputOptions& o);
/// --set key=value, whose `meaning` is whose key it is.
void add_overrides(
    CLI::App& command, std::vector<std::string>& overrides,
    const std::string& meaning = "key=value: another value for a key of the scene; repeatable");
void add_threads(CLI::App& command, int& threads);
/// The threads asked for, or one per processor where `threads` is 0.
int thread_count(int threads);
CLI::Option* add_device(CLI::App& command, std::string& device);

/// --slurm and what goes with it; returned is --slurm itself.
CLI::Option* add_submission_options(CLI::App& command, ClusterOptions& o);

/// Of commands whose work falls into pieces.
struct PieceOptions {
    ClusterOptions cluster;
    int point = -1;        ///< --point: this piece of the work only, counted from 0; −1: all
    bool collect = false;  ///< --collect: conclude from the pieces that lie there, compute none
    /// All of it is done, here and now.
    bool whole() const { return !cluster.submit && point < 0 && !collect; }
};
void add_piece_options(CLI::App& command, PieceOptions& o);

}  // namespace unravel::tool
