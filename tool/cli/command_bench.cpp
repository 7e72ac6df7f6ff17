// unravel bench [SCENE]: how fast a scene is simulated by size, or what pictures of it cost.

#include <fmt/format.h>
#include <unistd.h>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/program.hpp"
#include "tool/bench/frames.hpp"
#include "tool/bench/sized_scene.hpp"
#include "tool/bench/speed_report.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cluster/cluster.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

struct BenchOptions {
    fs::path scene;  // empty: hang; drape_sphere where pictures are timed
    fs::path folder = "output/bench";
    std::vector<std::string> overrides;
    std::string sizes;    // numbers of particles, with commas between
    double budget = 10;   // minutes
    bool frames = false;  // what pictures cost instead
    int threads = 0;
    std::string device = "auto";
    ClusterOptions cluster;
    std::vector<std::string> words;  // the command line as it was written
    OutputOptions output;
};

fs::path scene_of(const BenchOptions& options, const char* usual) {
    return options.scene.empty() ? shipped_scenes() / usual : options.scene;
}

constexpr const char* quick_sizes = "2500,10000,40000";

void write_plots(const fs::path& folder, const std::string& name, const std::vector<Plot>& plots) {
    write_whole_file(folder / (name + ".svg"), plots_svg(plots));
    write_png(folder / (name + ".png"), plots_image(plots, 1.5), {9, false});
}

int bench_speed(const BenchOptions& options) {
    SpeedPlan plan;
    plan.scene = scene_of(options, "hang.toml");
    plan.overrides = options.overrides;
    plan.sizes = parse_sizes(options.sizes.empty() ? quick_sizes : options.sizes);
    plan.threads = thread_count(options.threads);
    plan.seconds = 60 * options.budget;
    plan.tell = [&](const std::string& what) {
        if (!options.output.quiet) fmt::print(stderr, "{} ...\n", what);
    };
    const SpeedBench bench = measure_speed(plan);
    const fs::path& folder = options.folder;
    fs::create_directories(folder);
    const std::string json = speed_json(bench).dump(2) + "\n";
    write_whole_file(folder / "bench.json", json);
    write_whole_file(folder / "bench.md", speed_text(bench));
    write_whole_file(folder / "summary.md", speed_summary(bench));
    write_plots(folder, "bench", speed_plots(bench));
    write_plots(folder, "details", detail_plots(bench));
    if (options.output.json) {
        fmt::print("{}", json);
    } else if (!options.output.quiet) {
        fmt::print("{}\nplots, tables and records are in {}\n", speed_text(bench), folder.string());
    }
    return exit_done;
}

// What pictures of a scene cost, printed.
int bench_pictures(const BenchOptions& options) {
    constexpr int frames = 40;
    const Scene scene = load_scene(scene_of(options, "drape_sphere.toml"), options.overrides);
    const fs::path folder = fs::temp_directory_path() / fmt::format("unravel_bench_{}", getpid());
    const FrameBench bench =
        bench_frames(scene, frames, options.threads, parse_device_choice(options.device), folder);
    fmt::print("{}", options.output.json ? frame_bench_json(bench).dump(2) + "\n" : frame_bench_text(bench));
    return exit_done;
}

// As one job with a node for itself: what it times is compared, so that one machine has to time it all.
int send_bench(const BenchOptions& options) {
    ClusterWork work;
    work.name = "bench";
    work.what = "All of it on one node, which it has for itself: what is timed is compared.";
    work.words = options.words;
    work.results = options.folder;
    work.alone = work.undivided = true;
    work.unit = "bench";
    work.total = 1;
    work.done = [] { return 0; };
    return do_on_cluster(options.cluster, options.output, work);
}

int bench(const BenchOptions& options) {
    if (options.cluster.submit) return send_bench(options);
    return options.frames ? bench_pictures(options) : bench_speed(options);
}

}  // namespace

void add_bench(CommandLine& line) {
    const auto [command, o] =
        line.add("bench", "how fast it is by size, beside other solvers; or what pictures cost", bench);
    o.words = line.words();
    command.add_option("scene", o.scene,
                       "scene file whose cloth is refined (default: hang; with --frames drape_sphere)");
    command.add_option("-o", o.folder, "folder for tables, plots and records")->capture_default_str();
    CLI::Option* sizes = command.add_option(
        "--sizes", o.sizes, "numbers of particles with commas between (default: 2500,10000,40000)");
    command.add_option("--budget", o.budget, "minutes that it may take: repeats are cut, then slow rivals")
        ->check(CLI::Range(0.01, 10000.0))
        ->capture_default_str();
    CLI::Option* frames = command.add_flag(
        "--frames", o.frames,
        "what pictures cost instead: simulation, drawing, PNG and mp4 of both views, each alone "
        "and all together");
    sizes->excludes(frames);
    add_overrides(command, o.overrides);
    add_threads(command, o.threads);
    add_device(command, o.device)->needs(frames);
    add_submission_options(command, o.cluster);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
