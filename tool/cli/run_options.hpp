#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/picture_options.hpp"

namespace unravel::tool {

/// `run` and `simulate`, for one scene or several.
struct RunOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path folder;        ///< -o; empty: output/<scene name>
    std::vector<std::string> overrides;  ///< --set
    int threads = 0;                     ///< 0: one per processor
    bool resume = false, force = false;
    bool draft = false;           ///< coarse and quick, in a folder of its own
    bool allow_unstable = false;  ///< run although explicit springs are beyond their limit
    bool compare_whole = false;
    PictureOptions pictures;
    PieceOptions pieces;
    std::vector<std::string> words;  ///< the command line as it was written, from the command's name on
    OutputOptions output;
};

/// One scene's share of it: folder, overrides and all else are those of the options.
using RunOne = int (*)(const std::filesystem::path& scene, const RunOptions& options);

}  // namespace unravel::tool
