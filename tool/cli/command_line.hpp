#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// The command line: its commands as each of them describes itself, then what was written on it, and done.
class CommandLine {
public:
    /// `words`: what was written, from the command's name on.
    explicit CommandLine(std::vector<std::string> words);

    /// A command that is being described: where to put its options, and what they are read into.
    template <class Options>
    struct Command {
        CLI::App& line;
        Options& options;
    };

    /// Adds a command that does `act`, which returns an exit code and may throw what guarded() knows.
    template <class Options>
    Command<Options> add(const char* name, const char* what, int (*act)(const Options&)) {
        auto options = std::make_shared<Options>();
        return {add_command(name, what, [options, act] { return act(*options); }), *options};
    }

    const std::vector<std::string>& words() const { return words_; }
    /// All that was added, for those who tell of it.
    const CLI::App& description() const { return app_; }

    /// Reads the words and does what they ask for. Returns the exit code; throws nothing.
    int run();

private:
    CLI::App& add_command(const char* name, const char* what, std::function<int()> act);

    std::vector<std::string> words_;
    CLI::App app_;
    std::function<int()> chosen_;
};

}  // namespace unravel::tool
