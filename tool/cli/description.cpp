#include "tool/cli/description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "tool/base/version.hpp"

namespace unravel::tool {

namespace {

using Texts = std::vector<std::string>;

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    return app.get_options([](const CLI::Option*) { return true; });
}

// "-o", "--frames"; empty: it has no name but its place.
Texts names_of(const CLI::Option& option) {
    Texts names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

bool takes_value(const CLI::Option& option) {
    return option.get_items_expected_max() > 0;
}

// The words that an option takes, where it takes no others.
Texts words_of_option(const CLI::Option& option) {
    const std::string type = option.get_type_name();  // "TEXT:{mp4,none}"
    const std::size_t begin = type.find('{'), end = type.find('}', begin);
    Texts words;
    if (begin == type.npos || end == type.npos) return words;
    for (std::size_t at = begin + 1; at < end;) {
        const std::size_t next = std::min(type.find(',', at), end);
        words.push_back(type.substr(at, next - at));
        at = next + 1;
    }
    return words;
}

// Text that roff reads as it is.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else {
            out += c;
        }
    }
    return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string value_of(const CLI::Option& option) {
    const Texts words = words_of_option(option);
    if (!words.empty()) return fmt::format("{}", fmt::join(words, "|"));
    return option.get_type_name().starts_with("TEXT") ? "text" : "number";
}

void add_option(const CLI::Option& option, std::string& page) {
    const Texts names = names_of(option);
    std::string heading = names.empty() ? option.get_name(true) : fmt::format("{}", fmt::join(names, ", "));
    page += fmt::format(".TP\n.B {}\n", roff(heading));
    if (!names.empty() && takes_value(option)) {
        page.pop_back();
        page += fmt::format(" \\fI{}\\fR\n", roff(value_of(option)));
    }
    std::string what = option.get_description();
    if (!option.get_default_str().empty()) what += fmt::format(" (default: {})", option.get_default_str());
    page += roff(what) + "\n";
}

// What stands behind a command's name: its places, then [options].
std::string synopsis_of(const CLI::App& command) {
    std::string text;
    for (const CLI::Option* option : options_of(command)) {
        if (!option->get_positional()) continue;
        const std::string dots = option->get_items_expected_max() > 1 ? " ..." : "";
        text += option->get_required() ? fmt::format(" {}{}", option->get_name(true), dots)
                                       : fmt::format(" [{}{}]", option->get_name(true), dots);
    }
    return text + " [options]";
}

constexpr const char* end_of_page = R"(.SH EXIT STATUS
.TP
.B 0
done
.TP
.B 2
the command line asks for what cannot be
.TP
.B 3
a scene is wrong
.TP
.B 4
there is no usable renderer or encoder
.TP
.B 5
the simulation could not go on, or a study is not as it must be
.TP
.B 6
input or output failed: a full disk, a folder that can't be written
.TP
.B 130
interrupted
)";

}  // namespace

std::string command_names(const CLI::App& app) {
    std::string names;
    for (const CLI::App* command : commands_of(app)) names += command->get_name() + "\n";
    return names;
}

std::string man_page(const CLI::App& app) {
    std::string page = fmt::format(".TH UNRAVEL 1 \"\" \"unravel {}\" \"User commands\"\n", version());
    page += fmt::format(".SH NAME\nunravel \\- {}\n", "simulate cloth and render it off\\-screen");
    page += ".SH SYNOPSIS\n.B unravel\n.I command\n[options]\n";
    page += fmt::format(".SH DESCRIPTION\n{}\n", roff(app.get_description()));
    for (const CLI::App* command : commands_of(app)) {
        page += fmt::format(".SH {}\n.B unravel {}\n{}\n.PP\n{}\n", roff(command->get_name()),
                            roff(command->get_name()), roff(synopsis_of(*command).substr(1)),
                            roff(command->get_description()));
        for (const CLI::Option* option : options_of(*command)) add_option(*option, page);
    }
    return page + end_of_page;
}

std::string bash_completion(const CLI::App& app) {
    Texts commands;
    std::string options, words;
    for (const CLI::App* command : commands_of(app)) {
        commands.push_back(command->get_name());
        Texts names;
        for (const CLI::Option* option : options_of(*command)) {
            const Texts all = names_of(*option);
            names.insert(names.end(), all.begin(), all.end());
            const Texts taken = words_of_option(*option);
            if (taken.empty()) continue;
            // A place's words are offered wherever no option asks for others.
            words += all.empty() ? fmt::format("        {}:*) words=\"{}\" ;;\n", command->get_name(),
                                               fmt::join(taken, " "))
                                 : fmt::format("        {}:{}) words=\"{}\" ;;\n", command->get_name(),
                                               fmt::join(all, fmt::format("|{}:", command->get_name())),
                                               fmt::join(taken, " "));
        }
        options += fmt::format("        {}) options=\"{}\" ;;\n", command->get_name(), fmt::join(names, " "));
    }
    return fmt::format(R"(# bash completion for unravel {}, made by: unravel describe completion
_unravel() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command="${{COMP_WORDS[1]}}"
    local options="" words=""
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        COMPREPLY=($(compgen -W "{} --help --version" -- "$word"))
        return
    fi
    case "$command" in
{}    esac
    case "$command:$before" in
{}    esac
    if [[ "$word" == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
    elif [[ -n "$words" ]]; then
        COMPREPLY=($(compgen -W "$words" -- "$word"))
    else
        COMPREPLY=($(compgen -f -- "$word"))
    fi
}}
complete -o filenames -F _unravel unravel
)",
                       version(), fmt::join(commands, " "), options, words);
}

}  // namespace unravel::tool
