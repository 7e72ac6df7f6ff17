// unravel describe man|completion|commands: the tool itself, for manuals, shells and scripts.

#include <fmt/format.h>

#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/description.hpp"

namespace unravel::tool {

namespace {

struct DescribeOptions {
    std::string as;  // man, completion or commands
    const CLI::App* whole = nullptr;
};

int describe_tool(const DescribeOptions& options) {
    const auto text = options.as == "man"          ? man_page
                      : options.as == "completion" ? bash_completion
                                                   : command_names;
    fmt::print("{}", text(*options.whole));
    return exit_done;
}

}  // namespace

void add_describe(CommandLine& line) {
    const auto [command, o] =
        line.add("describe", "the tool itself, as a man page or for a shell's completion", describe_tool);
    o.whole = &line.description();
    command.add_option("what", o.as, "man, completion (bash; zsh by bashcompinit), or commands: their names")
        ->check(CLI::IsMember({"man", "completion", "commands"}))
        ->required();
}

}  // namespace unravel::tool
