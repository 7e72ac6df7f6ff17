#pragma once

#include <string>
#include <vector>

#include "tool/cli/command_line.hpp"

namespace unravel::tool {

// Each adds one command, described and done in the file of its name (command_run.cpp has two).
void add_run(CommandLine& line);
void add_simulate(CommandLine& line);
void add_preview(CommandLine& line);
void add_render(CommandLine& line);
void add_sheet(CommandLine& line);
void add_gallery(CommandLine& line);
void add_export(CommandLine& line);
void add_accuracy(CommandLine& line);
void add_inspect(CommandLine& line);
void add_reproduce(CommandLine& line);
void add_bench(CommandLine& line);
void add_schema(CommandLine& line);
void add_check(CommandLine& line);
void add_stability(CommandLine& line);
void add_verify(CommandLine& line);
void add_doctor(CommandLine& line);
void add_describe(CommandLine& line);

/// The whole tool: what is written behind its name, all its commands, done. Returns the exit code.
int run_command_line(std::vector<std::string> words);

}  // namespace unravel::tool
