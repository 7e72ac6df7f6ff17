// unravel check SCENE: what is wrong with it, or what would run.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/mesh/mesh_facts.hpp"
#include "sim/model/contact_model.hpp"
#include "sim/run/passages.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/solids/shape.hpp"
#include "sim/step/explicit_limit.hpp"
#include "sim/step/plan_text.hpp"
#include "sim/terms/effects.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/machine.hpp"
#include "tool/base/progress.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/forecast.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

struct CheckOptions {
    std::filesystem::path scene;
    std::vector<std::string> overrides;
    OutputOptions output;
};

// Calls visit(kind, name, file, facts) for every mesh of the scene.
template <class Visit>
void for_each_mesh(const Scene& scene, Visit&& visit) {
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.geometry) visit("cloth", cloth.name, cloth.mesh.file, facts_of(*cloth.geometry));
    }
    for (const Solid& solid : scene.solids) {
        if (solid.geometry) visit("solid", solid.name, solid.mesh.file, facts_of(*solid.geometry));
    }
}

nlohmann::ordered_json meshes_json(const Scene& scene) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for_each_mesh(scene, [&](const char* kind, const std::string& name, const std::string& file,
                             const MeshFacts& facts) {
        json.push_back({{kind, name},
                        {"file", file},
                        {"size", {facts.extent.x(), facts.extent.y(), facts.extent.z()}},
                        {"vertices", facts.vertices},
                        {"spacing", facts.spacing},
                        {"holes", nlohmann::ordered_json::array()}});
        for (const auto& border : facts.borders) json.back()["holes"].push_back(border.size());
    });
    return json;
}

// Two digits, and never more than it.
double round_down(double step) {
    const double unit = std::pow(10.0, std::floor(std::log10(step)) - 1);
    return std::floor(step / unit) * unit;
}

std::string rounding_words(const Solid& solid) {
    const double radius = law_of(solid.shape).rounding(solid);
    return radius > 0 ? fmt::format("a rounding of {:.2g} mm", 1e3 * radius) : std::string("sharp edges");
}

// At which distance layers touch, and what passes through what at the start.
std::vector<std::string> contact_notes(const Scene& scene, const Simulation& simulation) {
    std::vector<std::string> notes;
    const ClothModel& model = simulation.model;
    if (!model.contact) return notes;
    const ContactModel& contact = *model.contact;
    for (std::size_t c = 0; c < contact.thickness.size(); ++c) {
        const std::string name = scene.cloths[c].name.empty()
                                     ? fmt::format("cloth {}", c)
                                     : fmt::format("cloth \"{}\"", scene.cloths[c].name);
        if (contact.thickness[c] < contact.wanted[c])
            notes.push_back(fmt::format(
                "layers of {} touch at {:.2g} mm instead of {:.2g} mm: the start leaves them no more", name,
                1e3 * contact.thickness[c], 1e3 * contact.wanted[c]));
    }
    const Passages passages = find_passages(model, 0, simulation.state.x);
    if (!passages.cloth.empty()) {
        const Vec3 at = place_of(contact.surface, simulation.state.x, passages.cloth.front());
        notes.push_back(
            fmt::format("at the start {} edges of cloth pass through cloth, the first near "
                        "[{:.3f}, {:.3f}, {:.3f}]; they are not taken apart",
                        passages.cloth.size(), at.x(), at.y(), at.z()));
    }
    if (passages.solids.value_or(0) > 0) {
        const Vec3& at = simulation.state.x[passages.deepest_particle];
        notes.push_back(
            fmt::format("at the start {} edges of cloth pass through solids, up to {:.2g} mm deep near "
                        "[{:.3f}, {:.3f}, {:.3f}]",
                        *passages.solids, 1e3 * passages.deepest, at.x(), at.y(), at.z()));
    }
    const double spacing = widest_spacing(model);
    for (std::size_t s = 0; s < model.solids.size(); ++s) {
        const Solid& solid = model.solids[s];
        if (!needs_surfaces(solid, spacing) || scene.solids[s].contact == SolidContact::surface) continue;
        notes.push_back(fmt::format(
            "{} has {} and particles are up to {:.2g} mm apart: {}",
            solid.name.empty() ? fmt::format("solid {}", s) : fmt::format("solid \"{}\"", solid.name),
            rounding_words(solid), 1e3 * spacing,
            solid.by_surfaces() ? "it holds off edges and faces of the cloth, too (contact)"
                                : "they may miss it; contact = \"surface\" holds edges and faces off, too"));
    }
    return notes;
}

int check(const CheckOptions& options) {
    const Scene scene = load_scene(options.scene, options.overrides);
    check_textures(scene, scene.home);
    Simulation simulation = start_simulation(scene);
    require_explicit_stability(simulation.model, simulation.options, scene.solver.step);
    const std::vector<Effect> effects = list_effects(scene);
    const Forecast expected = forecast(scene, simulation);
    const MemoryRoom room = memory_room();
    BendLimit limit;
    limit_bend(simulation.model.bends, simulation.model.mass, scene.solver.step, limit);

    std::vector<std::string> notes = scene.notes;
    notes.insert(notes.end(), simulation.model.notes.begin(), simulation.model.notes.end());
    for (std::string& note : contact_notes(scene, simulation)) notes.push_back(std::move(note));
    const StepPlan& plan = plan_step(simulation.model, simulation.options, scene.solver.step, simulation.ws);

    if (options.output.json) {
        nlohmann::ordered_json json{{"scene", scene.name},
                                    {"particles", simulation.model.size()},
                                    {"frames", scene.clip.frames()},
                                    {"steps", expected.steps},
                                    {"settling_steps", simulation.settling},
                                    {"estimated_bytes", expected.bytes},
                                    {"estimated_bytes_with_pictures", expected.bytes_with_pictures},
                                    {"memory_room", room.bytes},
                                    {"estimated_seconds", expected.seconds},
                                    {"estimated_picture_seconds", expected.picture_seconds},
                                    {"bend_springs_limited", limit.limited}};
        json["meshes"] = meshes_json(scene);
        json["notes"] = notes;
        for (const Effect& e : effects) json["effects"][e.name] = {{"on", e.on}, {"because", e.because}};
        json["plan"] = plan_json(plan);
        fmt::print("{}\n", json.dump(2));
        return exit_done;
    }
    fmt::print("{}: no problem found\n", options.scene.string());
    fmt::print("  {} particles, {} stretch, {} shear and {} bend springs\n", simulation.model.size(),
               simulation.model.springs.stretch_count,
               simulation.model.springs.size() - simulation.model.springs.stretch_count,
               simulation.model.bends.size());
    for_each_mesh(scene, [](const char* kind, const std::string& name, const std::string& file,
                            const MeshFacts& facts) {
        fmt::print("  {} \"{}\": {}, {}\n", kind, name, file, facts_text(facts));
    });
    fmt::print("  {} frames at {} per second, {} steps of {} s{}\n", scene.clip.frames(),
               rate_text(scene.clip.fps), expected.steps, scene.solver.step,
               simulation.settling > 0 ? fmt::format(", {} of them before frame 0", simulation.settling)
                                       : std::string());
    fmt::print(
        "  about {:.0f} MB of memory, {:.0f} with pictures; on one core {}{} of simulation and {} of "
        "pictures\n",
        expected.bytes / 1e6, expected.bytes_with_pictures / 1e6, expected.longer ? "more than " : "",
        duration_text(expected.seconds), duration_text(expected.picture_seconds));
    if (expected.bytes_with_pictures > room.bytes)
        fmt::print("  note: {}: too little for {}\n", room.told(),
                   expected.bytes > room.bytes ? "the simulation" : "it with pictures");
    for (const auto& [name, words] : plan_words(plan)) fmt::print("  {:<19} {}\n", name, words);
    for (const Effect& e : effects)
        fmt::print("  {:<15} {} because {}\n", e.name, e.on ? "on, " : "off,", e.because);
    for (const std::string& note : notes) fmt::print("  note: {}\n", note);
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

}  // namespace

void add_check(CommandLine& line) {
    const auto [command, o] = line.add("check", "what is wrong with a scene, or what would run", check);
    command.add_option("SCENE", o.scene, "scene file")->required();
    add_overrides(command, o.overrides);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
