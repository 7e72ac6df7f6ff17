#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tool/base/names.hpp"

namespace unravel::tool {

// What a command line says of itself, told in other ways than --help.

/// The commands' names, one a line.
std::string command_names(const CLI::App& app);

/// A man page in man(7) macros: every command with its options, exit codes, files.
std::string man_page(const CLI::App& app);

/// A script that gives bash (and zsh by bashcompinit) the commands, their options, and the words and files
/// that options take.
std::string bash_completion(const CLI::App& app);

}  // namespace unravel::tool
