// unravel describe man|completion: the tool itself, for manuals and shells.

#include <fmt/format.h>

#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/description.hpp"

namespace unravel::tool {

namespace {

struct DescribeOptions {
    std::string as;  // man or completion
    const CLI::App* whole = nullptr;
};

int describe_tool(const DescribeOptions& options) {
    fmt::print("{}", options.as == "man" ? man_page(*options.whole) : bash_completion(*options.whole));
    return exit_done;
}

}  // namespace

void add_describe(CommandLine& line) {
    const auto [command, o] =
        line.add("describe", "the tool itself, as a man page or for a shell's completion", describe_tool);
    o.whole = &line.description();
    command.add_option("what", o.as, "man, or completion (bash; zsh by bashcompinit)")
        ->check(CLI::IsMember({"man", "completion"}))
        ->required();
}

}  // namespace unravel::tool
