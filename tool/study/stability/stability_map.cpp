#include "tool/study/stability/stability_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/plot/plot.hpp"

namespace unravel::tool {

namespace {

constexpr int fewest_steps = 60;

double largest_kappa(const ClothModel& model, double h) {
    double largest = 0;
    const ExtensionSprings& springs = model.springs;
    for (std::size_t s = 0; s < springs.stretch_count; ++s) {
        largest = std::max(largest, kappa_between(h, model.mass[springs.i[s]], model.mass[springs.j[s]],
                                                  springs.stiffness[s], springs.damping[s]));
    }
    return largest;
}

MapCell run_cell(const std::filesystem::path& file, const std::string& integrator, double stretch,
                 int divisor, const Rate& fps) {
    MapCell cell;
    cell.stretch = stretch;
    const Scene scene = load_scene(file, {fmt::format("solver.integrator=\"{}\"", integrator),
                                          fmt::format("cloth.material.stretch={:e}", stretch),
                                          fmt::format("cloth.material.shear={:e}", 0.5 * stretch),
                                          fmt::format("solver.step=\"{}\"", step_text(fps, divisor))});
    cell.step = scene.solver.step;
    Simulation simulation = start_simulation(scene);
    cell.kappa = largest_kappa(simulation.model, cell.step);
    const int frames = std::max(scene.clip.frames() - 1, (fewest_steps + divisor - 1) / divisor);
    double before = -1;
    try {
        for (int frame = 0; frame < frames && cell.stable; ++frame) {
            for (const StepReport& r : next_record(simulation).reports) {
                if (before < 0) before = r.kinetic + r.potential;
                cell.stable = cell.stable && r.kinetic + r.potential <= 2 * before;
            }
        }
    } catch (const SimulationError&) {
        cell.stable = false;
    }
    return cell;
}

Plot plot_of(const StabilityMap& map) {
    Plot plot;
    plot.title = fmt::format("{}: where it is stable", map.integrator);
    plot.x = {"stiffness [N/m]", true, {}, {}, {}};
    plot.y = {"step [s]", true, {}, {}, {}};
    PlotSeries stable, unstable, limit;
    stable.label = "stable";
    unstable.label = "blows up";
    limit.label = "kappa = 1/2";
    stable.style = unstable.style = SeriesStyle::points;
    limit.style = SeriesStyle::line;
    limit.dashed = true;
    for (const MapCell& cell : map.cells) {
        PlotPoint point;
        point.x = cell.stretch;
        point.y = cell.step;
        (cell.stable ? stable : unstable).points.push_back(point);
        // Without damping kappa grows as the step's square.
        point.y = cell.step * std::sqrt(0.5 / cell.kappa);
        if (limit.points.empty() || limit.points.back().x < point.x) limit.points.push_back(point);
    }
    std::erase_if(limit.points, [&](const PlotPoint& p) {
        return p.y > map.cells.front().step || p.y < map.cells.back().step;
    });
    plot.series = {stable, unstable, limit};
    return plot;
}

}  // namespace

StabilityMap make_stability_map(const std::filesystem::path& scene, const std::string& integrator) {
    const Rate fps = load_scene(scene).clip.fps;
    StabilityMap map{integrator, {}};
    for (int divisor = 1; divisor <= 64; divisor *= 2) {
        for (int decade = 0; decade <= 12; ++decade)
            map.cells.push_back(run_cell(scene, integrator, std::pow(10.0, 0.5 * decade), divisor, fps));
    }
    return map;
}

std::vector<std::string> write_stability_maps(const std::filesystem::path& folder,
                                              const std::vector<StabilityMap>& maps) {
    std::vector<std::string> pictures;
    std::string csv = "integrator,stretch,step,kappa,stable\n";
    for (const StabilityMap& map : maps) {
        for (const MapCell& cell : map.cells) {
            csv += fmt::format("{},{:.6g},{:.9g},{:.6g},{:d}\n", map.integrator, cell.stretch, cell.step,
                               cell.kappa, cell.stable);
        }
        const Plot plot = plot_of(map);
        pictures.push_back(fmt::format("map_{}.svg", map.integrator));
        write_whole_file(folder / pictures.back(), plot_svg(plot));
        write_png(folder / fmt::format("map_{}.png", map.integrator), plot_image(plot));
    }
    write_whole_file(folder / "map.csv", csv);
    return pictures;
}

}  // namespace unravel::tool
