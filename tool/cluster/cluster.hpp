#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/base/output.hpp"
#include "tool/cluster/cluster_options.hpp"

namespace unravel::tool {

/// A command's work as a cluster does it: pieces that don't depend on each other, each the very command that
/// does all of it on one machine with `--point K` behind, and the same command with `--collect` to conclude.
/// What a piece leaves are whole files on a disk that all nodes share; nothing else passes between them.
struct ClusterWork {
    std::string name;                ///< of the command, for jobs, scripts and logs
    std::string what;                ///< a piece, for people: "range K of 8 of the frames of output/flag"
    std::filesystem::path results;   ///< folder of the results
    std::vector<std::string> words;  ///< the command line as the user wrote it, from the command's name on
    std::vector<std::string> more;   ///< words to be put behind the user's own
    std::vector<int> missing;        ///< pieces to be done, counted from 0, ascending
    std::string before;              ///< words of what must be done before any piece; empty: nothing
    bool threads = false;            ///< the command takes --threads, and the user named no number
    bool alone = false;              ///< pieces are timed
    bool undivided = false;          ///< one job does it all, and nothing is to be concluded after it
    std::function<void()> prepare;   ///< done here before anything is sent; empty: nothing
    std::string unit = "frame";      ///< what is counted while waiting
    int total = 0;                   ///< of them
    std::function<int()> done;       ///< how many lie there
};

/// Sends it as one array job and one job after it, and says so; with --wait stays until all has ended and
/// passes on what the last job printed and its exit code; with --dry-run only prints the scripts. Work that
/// is in the queue already is not sent again: --wait waits for it, FolderError otherwise. Throws OutputError,
/// and std::runtime_error with Slurm's words.
int do_on_cluster(const ClusterOptions& options, const OutputOptions& output, const ClusterWork& work);

/// Some pieces are not there, so that the work can't be concluded; what() names them. Exit code 5.
class MissingPieces : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Why a piece is missing, from what its task printed last. For people.
std::string why_missing(const std::filesystem::path& results, const std::string& name, int piece);

/// A command line without some of its options.
///   flags   options that stand for themselves
///   valued  options that a value follows
std::vector<std::string> words_without(const std::vector<std::string>& words,
                                       const std::vector<std::string>& flags,
                                       const std::vector<std::string>& valued);

/// The user's words that are for every piece: without those about the cluster itself.
std::vector<std::string> piece_words(const std::vector<std::string>& words);

}  // namespace unravel::tool
