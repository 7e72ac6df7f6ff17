// unravel stability: every hard case, with what must happen, what happened, numbers and a picture.

#include <fmt/format.h>

#include <algorithm>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"
#include "tool/hard_case.hpp"
#include "tool/interrupt.hpp"
#include "tool/options.hpp"
#include "tool/render_options.hpp"
#include "tool/stability_map.hpp"
#include "tool/stability_report.hpp"
#include "tool/view.hpp"

namespace unravel {

namespace {

constexpr int picture_width = 480, picture_height = 270;

bool is_asked_for(const HardCase& hard, const std::vector<std::string>& names) {
    return names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
               return hard.name.find(name) != std::string::npos;
           });
}

// A scene that is refused has no state to be drawn.
bool draw_case(const GlContext& context, const HardOutcome& outcome, const std::filesystem::path& file) {
    if (!outcome.scene || outcome.last.state.x.empty()) return false;
    const Scene& scene = *outcome.scene;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    DrawFrame frame;
    make_draw_frame(scene, model, outcome.last, std::vector<Rgb>(model.size()), frame);
    Renderer renderer(context, drawn, {picture_width, picture_height, 4, 1});
    Image image;
    renderer.draw(DrawStyle::textured, frame, image);
    write_png(file, image);
    return true;
}

std::vector<std::string> draw_maps(const std::filesystem::path& scene, const std::filesystem::path& output,
                                   bool quiet) {
    std::vector<StabilityMap> maps;
    for (const char* integrator :
         {"explicit", "imex", "adaptive-imex", "adaptive-imex2", "implicit", "bdf2"}) {
        if (InterruptWatch::requested()) break;
        maps.push_back(make_stability_map(scene, integrator));
        const auto& cells = maps.back().cells;
        // The paper's claim: nothing blows up below kappa = 1/2.
        const auto below = std::count_if(cells.begin(), cells.end(), [](const MapCell& cell) {
            return cell.kappa <= 0.5 && !cell.stable;
        });
        const auto broken =
            std::count_if(cells.begin(), cells.end(), [](const MapCell& cell) { return !cell.stable; });
        if (!quiet) {
            fmt::print("map of {:<15} {} of {} runs blow up, {} of them at kappa <= 1/2\n", integrator,
                       broken, cells.size(), below);
            std::fflush(stdout);
        }
    }
    return write_stability_maps(output, maps);
}

}  // namespace

int command_stability(const Options& options) {
    const std::filesystem::path folder = options.scene.empty() ? "scenes/hard" : options.scene;
    const std::filesystem::path output = options.output.empty() ? "output/stability" : options.output;
    std::vector<HardCase> cases = read_hard_cases(folder / "cases.toml");
    std::erase_if(cases, [&](const HardCase& hard) { return !is_asked_for(hard, options.cases); });
    if (cases.empty()) throw UsageError("no hard case has such a name; scenes/hard/cases.toml lists them");
    std::error_code error;
    std::filesystem::create_directories(output, error);
    if (error) throw OutputError(output, error.value());

    const InterruptWatch watch;
    std::optional<GlContext> context;
    if (options.pictures) context.emplace(parse_device_choice(options.device));
    std::vector<HardLine> lines;
    for (const HardCase& hard : cases) {
        if (InterruptWatch::requested()) return exit_interrupted;
        HardLine line{hard, run_hard_case(hard), ""};
        if (context && draw_case(*context, line.outcome, output / (hard.name + ".png")))
            line.picture = hard.name + ".png";
        if (!options.quiet && !options.json) {
            fmt::print("{}\n", terminal_line(line));
            std::fflush(stdout);
        }
        line.outcome.last = {};
        lines.push_back(std::move(line));
    }
    std::vector<std::string> maps;
    if (options.map) maps = draw_maps(folder / "map.toml", output, options.quiet || options.json);
    const nlohmann::ordered_json json = stability_json(lines);
    write_whole_file(output / "stability.json", json.dump(2) + "\n");
    write_whole_file(output / "table.md", stability_markdown(lines));
    write_whole_file(output / "index.html", stability_html(lines, maps));
    const auto wrong = std::count_if(lines.begin(), lines.end(),
                                     [](const HardLine& line) { return !line.outcome.failures.empty(); });
    if (options.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.quiet) {
        fmt::print("{} of {} cases as they must be\n  {}\n", lines.size() - static_cast<std::size_t>(wrong),
                   lines.size(), (output / "index.html").string());
    }
    return wrong == 0 ? exit_done : exit_simulation;
}

}  // namespace unravel
