#include "tool/bench/command_speed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "source_dir.hpp"
#include "tool/bench/sized_scene.hpp"
#include "tool/bench/speed_report.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr const char* quick_sizes = "2500,10000,40000";

void write_plots(const fs::path& folder, const std::string& name, const std::vector<Plot>& plots) {
    write_whole_file(folder / (name + ".svg"), plots_svg(plots));
    write_png(folder / (name + ".png"), plots_image(plots, 1.5), {9, false});
}

}  // namespace

int command_bench_speed(const Options& options) {
    SpeedPlan plan;
    plan.scene = options.scene.empty() ? fs::path(UNRAVEL_SCENES) / "hang.toml" : options.scene;
    plan.overrides = options.overrides;
    plan.sizes = parse_sizes(options.sizes.empty() ? quick_sizes : options.sizes);
    plan.threads = options.threads > 0 ? options.threads
                                       : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    plan.seconds = 60 * options.budget;
    plan.tell = [&](const std::string& what) {
        if (!options.quiet) fmt::print(stderr, "{} ...\n", what);
    };
    const SpeedBench bench = measure_speed(plan);
    const fs::path folder = options.output.empty() ? fs::path("output") / "bench" : options.output;
    fs::create_directories(folder);
    const std::string json = speed_json(bench).dump(2) + "\n";
    write_whole_file(folder / "bench.json", json);
    write_whole_file(folder / "bench.md", speed_text(bench));
    write_whole_file(folder / "summary.md", speed_summary(bench));
    write_plots(folder, "bench", speed_plots(bench));
    write_plots(folder, "details", detail_plots(bench));
    if (options.json) {
        fmt::print("{}", json);
    } else if (!options.quiet) {
        fmt::print("{}\nplots, tables and records are in {}\n", speed_text(bench), folder.string());
    }
    return exit_done;
}

}  // namespace unravel::tool
