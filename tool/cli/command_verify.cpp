// unravel verify: analytic cases on several grids and with several steps, theory beside measured.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file_errors.hpp"
#include "base/whole_file.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/study/verify/verify_report.hpp"

namespace unravel::tool {

namespace {

struct VerifyOptions {
    std::vector<std::string> cases;  // names, or parts of them; empty: all
    bool fast = false;
    std::filesystem::path folder = "output/verify";
    OutputOptions output;
};

bool is_asked_for(const VerifyCase& of, const std::vector<std::string>& names) {
    return names.empty() || std::ranges::any_of(names, [&](const std::string& name) {
               return std::string_view(of.name).find(name) != std::string_view::npos;
           });
}

int verify(const VerifyOptions& options) {
    const InterruptWatch watch;
    std::vector<VerifyOutcome> outcomes;
    for (const VerifyCase& of : verify_cases()) {
        if (InterruptWatch::requested()) return InterruptWatch::exit_code();
        if (!is_asked_for(of, options.cases)) continue;
        outcomes.push_back(run_verify_case(of, options.fast));
        if (!options.output.talks()) continue;
        fmt::print("{}\n", terminal_text(outcomes.back()));
        std::fflush(stdout);
    }
    if (outcomes.empty()) throw UsageError("no case has such a name");
    std::error_code error;
    std::filesystem::create_directories(options.folder, error);
    if (error) throw OutputError(options.folder, error.value());
    const nlohmann::ordered_json json = verify_json(outcomes);
    write_whole_file(options.folder / "verify.json", json.dump(2) + "\n");
    write_whole_file(options.folder / "verify.md", verify_markdown(outcomes));
    write_whole_file(options.folder / "index.html", verify_html(outcomes));
    if (options.output.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.output.quiet) {
        fmt::print("\n{}\n  {}\n", verify_summary(outcomes), (options.folder / "index.html").string());
    }
    const bool all = std::ranges::all_of(outcomes, [](const VerifyOutcome& o) { return o.wrong() == 0; });
    return all ? exit_done : exit_simulation;
}

}  // namespace

void add_verify(CommandLine& line) {
    const auto [command, o] =
        line.add("verify", "the physics against theory, on several grids and with several steps", verify);
    command.add_option("cases", o.cases, "names of cases, or parts of them (default: all)");
    command.add_flag("--fast", o.fast, "only each case's first grid and step");
    command.add_option("-o", o.folder, "folder for the results")->capture_default_str();
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
