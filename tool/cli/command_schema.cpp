// unravel schema scene|keys|run|bench|stats: what the tool's files hold, for editors, programs and readers.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/run/stats.hpp"
#include "sim/scene_file/reference.hpp"
#include "sim/scene_file/schema.hpp"
#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/report/page_files.hpp"

namespace unravel::tool {

namespace {

struct SchemaOptions {
    std::string what;  // scene, keys, run, bench or stats
    OutputOptions output;
};

nlohmann::ordered_json stats_list() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const StatsColumn& column : stats_columns()) {
        list.push_back(
            {{"column", column.name}, {"meaning", column.meaning}, {"differs_between_runs", column.timing}});
    }
    return list;
}

int schema(const SchemaOptions& options) {
    if (options.what == "scene") {
        fmt::print("{}\n", scene_schema().dump(2));
    } else if (options.what == "keys") {
        fmt::print("{}", scene_reference());
    } else if (options.what == "run") {
        fmt::print("{}", page_file("run.schema.json"));
    } else if (options.what == "bench") {
        fmt::print("{}", page_file("bench.schema.json"));
    } else if (options.output.json) {
        fmt::print("{}\n", stats_list().dump(2));
    } else {
        for (const StatsColumn& column : stats_columns())
            fmt::print("{:<18} {}\n", column.name, column.meaning);
    }
    return exit_done;
}

}  // namespace

void add_schema(CommandLine& line) {
    const auto [command, o] = line.add("schema", "what files hold, for editors and programs", schema);
    command
        .add_option("what", o.what,
                    "scene, run or bench (JSON schemas), keys (the scene's, as Markdown), stats (columns of "
                    "stats.csv)")
        ->check(CLI::IsMember({"scene", "keys", "run", "bench", "stats"}))
        ->required();
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
