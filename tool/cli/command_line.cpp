#include "tool/cli/command_line.hpp"

#include <iostream>
#include <utility>

#include "tool/base/exit.hpp"
#include "tool/base/version.hpp"
#include "tool/cli/guarded.hpp"

namespace unravel::tool {

CommandLine::CommandLine(std::vector<std::string> words)
    : words_(std::move(words)),
      app_("Unravel: cloth simulated with a decomposing solver, rendered off-screen.", "unravel") {
    app_.set_version_flag("--version", version());
    app_.require_subcommand(1);
}

CLI::App& CommandLine::add_command(const char* name, const char* what, std::function<int()> act) {
    CLI::App* const command = app_.add_subcommand(name, what);
    command->callback([this, act = std::move(act)] { chosen_ = act; });
    return *command;
}

int CommandLine::run() {
    try {
        app_.parse(std::vector<std::string>(words_.rbegin(), words_.rend()));  // CLI11 takes them from behind
    } catch (const CLI::ParseError& error) {
        if (app_.exit(error) != 0) return exit_usage;
        std::cout.flush();  // help goes there
        return guarded([] { return exit_done; });
    }
    return guarded(chosen_);
}

}  // namespace unravel::tool
