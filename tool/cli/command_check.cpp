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
#include "tool/base/options.hpp"
#include "tool/base/progress.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

// Rough cost on one 2.4 GHz server core, fitted to the scenes that ship: within a factor of two of each.
// Seconds per particle and step:
constexpr double grid_step = 0.6e-6, mesh_step = 2.6e-6;  // springs and solve
constexpr double contact_step = 0.5e-6;                   // with solids of a closed form
constexpr double mesh_contact_step = 3.5e-6;              // with meshes
constexpr double self_collision_step = 0.8e-6;
// Seconds per frame of 1280 × 720, both views with PNG and video:
constexpr double frame_pictures = 0.11;
constexpr double bytes_per_particle = 1900;

double step_seconds(const Scene& scene, const ClothModel& model) {
    double seconds = 0;
    double contact = scene.self_collision ? self_collision_step : 0;
    if (!scene.solids.empty()) {
        const bool mesh = std::any_of(scene.solids.begin(), scene.solids.end(),
                                      [](const Solid& solid) { return solid.shape == Shape::mesh; });
        contact += mesh ? mesh_contact_step : contact_step;
    }
    for (const ClothPatch& cloth : model.cloths)
        seconds += cloth.count() * (contact + (cloth.grid() ? grid_step : mesh_step));
    return seconds;
}

double picture_seconds(const Scene& scene) {
    const double area = static_cast<double>(scene.clip.size[0]) * scene.clip.size[1];
    return scene.clip.frames() * frame_pictures * area / (1280.0 * 720.0);
}

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
    const double n = static_cast<double>(simulation.model.size());
    const long steps = static_cast<long>(simulation.steps_per_frame) * (scene.clip.frames() - 1);
    const double seconds = static_cast<double>(steps) * step_seconds(scene, simulation.model);
    const double pictures = picture_seconds(scene);
    BendLimit limit;
    limit_bend(simulation.model.bends, simulation.model.mass, scene.solver.step, limit);

    if (options.json) {
        nlohmann::ordered_json json{{"scene", scene.name},
                                    {"particles", simulation.model.size()},
                                    {"frames", scene.clip.frames()},
                                    {"steps", steps},
                                    {"estimated_bytes", n * bytes_per_particle},
                                    {"estimated_seconds", seconds},
                                    {"estimated_picture_seconds", pictures},
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
    fmt::print("  {} frames at {} per second, {} steps of {} s\n", scene.clip.frames(), scene.clip.fps, steps,
               scene.solver.step);
    fmt::print("  about {:.0f} MB of memory, on one core {} of simulation and {} of pictures\n",
               n * bytes_per_particle / 1e6, duration_text(seconds), duration_text(pictures));
    if (scene.solver.integrator == Integrator::automatic) {
        const IntegratorCosts costs =
            count_costs(simulation.model, simulation.options, scene.solver.step, simulation.ws);
        fmt::print(
            "  auto takes {}: explicit would need {:.6g} substeps, about {:.2g} us per particle and step against "
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
