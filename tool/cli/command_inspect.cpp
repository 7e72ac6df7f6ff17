// unravel inspect RUN_DIR --frame K: one step of a run, simulated again and shown from inside.

#include <fmt/format.h>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/step/plan_text.hpp"
#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/inspect/numbers.hpp"
#include "tool/inspect/page.hpp"
#include "tool/picture/still.hpp"

namespace unravel::tool {

namespace {

struct InspectOptions {
    std::filesystem::path run;
    int frame = 0, step = 0;                  // the step within the frame; 0: its last
    std::int64_t particle = -1, spring = -1;  // −1: none asked for
    std::string device = "auto";
    OutputOptions output;
};

constexpr std::size_t rows_on_terminal = 12;

void print_step(const InspectedStep& step) {
    const StepReport& r = step.report;
    fmt::print("frame {}, step {} of {} (step {} of the run, {:.6g} s)\n", step.frame, step.step, step.steps,
               r.step, r.t);
    fmt::print("  {} components, the largest of {} particles; {} fully and {} partly constrained\n",
               r.components, r.largest, r.constrained, r.partly);
    fmt::print("  springs: {} implicit, {} explicit, {} inactive\n", r.implicit, r.explicit_, r.inactive);
    fmt::print("  {} CG iterations, at most {} in one; {} RVMs\n", r.cg_iterations, r.cg_iterations_max,
               r.rvm);
    for (const auto& [name, words] : plan_words(step.trace().plan)) fmt::print("  {:<19} {}\n", name, words);
    fmt::print("\n");
    fmt::print("  {:>6} {:>10} {:>9} {:>9} {:>11} {:>9} {:>9}\n", "id", "particles", "boundary", "springs",
               "iterations", "RVMs", "residual");
    for (std::size_t k = 0; k < std::min(step.components.size(), rows_on_terminal); ++k) {
        const ComponentRow& row = step.components[k];
        fmt::print("  {:>6} {:>10} {:>9} {:>9} {:>11} {:>9} {:>9.2e}\n", row.id, row.particles, row.boundary,
                   row.springs, row.solve.iterations, row.solve.rvm, row.solve.residual);
    }
    if (step.components.size() > rows_on_terminal)
        fmt::print("  … and {} smaller ones\n", step.components.size() - rows_on_terminal);
}

int inspect(const InspectOptions& options) {
    const CachedRun run = open_cached_run(options.run);
    const InspectedStep step = inspect_step(run, options.frame, options.step);

    std::vector<std::pair<std::string, nlohmann::ordered_json>> asked;
    if (options.particle >= 0)
        asked.emplace_back(fmt::format("Particle {}", options.particle),
                           particle_numbers(step, options.particle));
    if (options.spring >= 0)
        asked.emplace_back(fmt::format("Spring {}", options.spring), spring_numbers(step, options.spring));

    // The numbers are worth having where nothing can be drawn.
    std::vector<Image> views;
    std::string no_views;
    try {
        views = draw_still(run.scene, step.simulation.model, step.record, step.colors,
                           parse_device_choice(options.device));
    } catch (const RendererError& error) {
        no_views = error.what();
    }
    const std::vector<Figure> figures = step_figures(step);

    const std::filesystem::path into = run.folder.root / "inspect";
    std::filesystem::create_directories(into);
    const std::string name = step.step == step.steps ? fmt::format("{:04}", step.frame)
                                                     : fmt::format("{:04}_step{}", step.frame, step.step);
    for (const Figure& figure : figures) {
        write_whole_file(into / fmt::format("{}_{}.svg", figure.name, name), figure.svg);
        write_png(into / fmt::format("{}_{}.png", figure.name, name), figure.image, {9, false});
    }
    const std::filesystem::path page = into / fmt::format("inspect_{}.html", name);
    const std::string run_name =
        std::filesystem::absolute(run.folder.root).lexically_normal().filename().string();
    write_whole_file(page, inspect_page(step, run_name, views, no_views, figures, asked));

    if (options.output.json) {
        nlohmann::ordered_json json = step_numbers(step);
        if (options.particle >= 0) json["particle"] = particle_numbers(step, options.particle);
        if (options.spring >= 0) json["spring"] = spring_numbers(step, options.spring);
        json["page"] = page.string();
        fmt::print("{}\n", json.dump(2));
    } else if (!options.output.quiet) {
        print_step(step);
        for (const auto& [heading, numbers] : asked) fmt::print("\n{}\n{}\n", heading, numbers.dump(2));
        if (!no_views.empty()) fmt::print("\nno views: {}\n", no_views);
        fmt::print("\n  {}\n", page.string());
    }
    return exit_done;
}

}  // namespace

void add_inspect(CommandLine& line) {
    const auto [command, o] =
        line.add("inspect", "one frame in depth: components, splitting, the matrix", inspect);
    command.add_option("RUN_DIR", o.run, "folder of the run")->required();
    command.add_option("--frame", o.frame, "number of the frame, 1 or more")->required();
    command.add_option("--step", o.step, "step on the way to that frame, 1 or more (default: the last)")
        ->check(CLI::Range(1, 1000000));
    command.add_option("--particle", o.particle, "tell all about this particle")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--spring", o.spring, "tell all about this stretch or shear spring")
        ->check(CLI::NonNegativeNumber);
    add_device(command, o.device);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
