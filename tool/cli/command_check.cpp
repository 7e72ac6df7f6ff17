// unravel check SCENE: what is wrong with it, or what would run.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/model/effects.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/step/choose_integrator.hpp"
#include "sim/step/explicit_limit.hpp"
#include "tool/base/machine.hpp"
#include "tool/base/options.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/forecast.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

// Two digits, and never more than it.
double round_down(double step) {
    const double unit = std::pow(10.0, std::floor(std::log10(step)) - 1);
    return std::floor(step / unit) * unit;
}

}  // namespace

int command_check(const Options& options) {
    const Scene scene = load_scene(options.scene, options.overrides);
    check_textures(scene, options.scene.has_parent_path() ? options.scene.parent_path() : ".");
    Simulation simulation = start_simulation(scene);
    require_explicit_stability(simulation.model, simulation.options, scene.solver.step);
    const std::vector<Effect> effects = list_effects(scene);
    const Forecast expected = forecast(scene, simulation);
    const MemoryRoom room = memory_room();
    BendLimit limit;
    limit_bend(simulation.model.bends, simulation.model.mass, scene.solver.step, limit);

    if (options.json) {
        nlohmann::ordered_json json{{"scene", scene.name},
                                    {"particles", simulation.model.size()},
                                    {"frames", scene.clip.frames()},
                                    {"steps", expected.steps},
                                    {"estimated_bytes", expected.bytes},
                                    {"memory_room", room.bytes},
                                    {"estimated_seconds", expected.seconds},
                                    {"estimated_picture_seconds", expected.picture_seconds},
                                    {"bend_springs_limited", limit.limited}};
        for (const Effect& e : effects) json["effects"][e.name] = {{"on", e.on}, {"because", e.because}};
        fmt::print("{}\n", json.dump(2));
        return exit_done;
    }
    fmt::print("{}: no problem found\n", options.scene.string());
    fmt::print("  {} particles, {} stretch, {} shear and {} bend springs\n", simulation.model.size(),
               simulation.model.springs.stretch_count,
               simulation.model.springs.size() - simulation.model.springs.stretch_count,
               simulation.model.bends.size());
    fmt::print("  {} frames at {} per second, {} steps of {} s\n", scene.clip.frames(),
               rate_text(scene.clip.fps), expected.steps, scene.solver.step);
    fmt::print("  about {:.0f} MB of memory, on one core {}{} of simulation and {} of pictures\n",
               expected.bytes / 1e6, expected.longer ? "more than " : "", duration_text(expected.seconds),
               duration_text(expected.picture_seconds));
    if (const auto [width, height] = scene.clip.size; width % 2 != 0 || height % 2 != 0)
        fmt::print("  note: {} × {} is no size for an mp4, which has even ones: --video webm, mkv or gif\n",
                   width, height);
    if (expected.bytes > room.bytes)
        fmt::print("  note: that is more memory than there is: {}\n", room.told());
    if (scene.solver.integrator == Integrator::automatic) {
        const IntegratorCosts costs =
            count_costs(simulation.model, simulation.options, scene.solver.step, simulation.ws);
        fmt::print(
            "  auto takes {}: explicit would need {} substeps, about {:.2g} us per particle and step against "
            "{:.2g}\n",
            costs.cheaper() == Integrator::explicit_ ? "explicit substeps" : "adaptive-imex", costs.substeps,
            1e-3 * costs.explicit_cost, 1e-3 * costs.coupled_cost);
    }
    for (const Effect& e : effects)
        fmt::print("  {:<15} {} because {}\n", e.name, e.on ? "on, " : "off,", e.because);
    if (limit.limited > 0) {
        fmt::print(
            "  note: {} of {} bend springs resist the onset of buckling less than the material would, so "
            "that they "
            "stay stable explicitly at this step; a step of {:.2g} s leaves them as they are\n",
            limit.limited, simulation.model.bends.size(), [&] {
                double smallest = scene.solver.step;
                const BendSprings& b = simulation.model.bends;
                for (std::size_t s = 0; s < b.size(); ++s) {
                    const double m = std::min(simulation.model.mass[b.i[s]], simulation.model.mass[b.j[s]]);
                    smallest = std::min(smallest, std::sqrt(bend_slope_limit * m / b.slope[s]));
                }
                return round_down(smallest);
            }());
    }
    return exit_done;
}

}  // namespace unravel::tool
