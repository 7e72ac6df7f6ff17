#include "tool/cli/commands.hpp"

namespace unravel::tool {

int run_command_line(std::vector<std::string> words) {
    CommandLine line(std::move(words));
    // In the order in which --help lists them.
    for (const auto add : {add_run, add_simulate, add_preview, add_render, add_sheet, add_gallery, add_export,
                           add_accuracy, add_inspect, add_reproduce, add_bench, add_schema, add_check,
                           add_stability, add_verify, add_doctor, add_describe})
        add(line);
    return line.run();
}

}  // namespace unravel::tool
