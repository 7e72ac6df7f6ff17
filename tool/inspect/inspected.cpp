#include "tool/inspect/inspected.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tool/base/exit.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

// The step gathers forces by particle; what each spring put in is evaluated again.
std::vector<Vec3> forces_of(const InspectedStep& step) {
    const Simulation& simulation = step.simulation;
    const StepWorkspace& ws = simulation.ws;
    const StepOptions& options = simulation.options;
    const Integrator used = options.integrator == Integrator::automatic ? ws.chosen : options.integrator;
    const Splitting splitting = scheme_of(used).splitting(options.threshold);
    const bool coupled = used != Integrator::explicit_;  // a swept step leaves no stage behind
    const std::span<const Vec3> x = coupled ? ws.stage.x_at : std::span<const Vec3>(step.before.x),
                                v = coupled ? ws.stage.v_at : std::span<const Vec3>(step.before.v);
    ExtensionForces forces;
    extension_forces(simulation.model.springs, simulation.model.mass, x, v, step.report.h, splitting,
                     options.activation_band, forces,
                     coupled ? std::span<const std::uint8_t>(ws.taut) : std::span<const std::uint8_t>(),
                     coupled ? std::span<const Vec3>(ws.ahead) : std::span<const Vec3>());
    return forces.force;
}

}  // namespace

InspectedStep inspect_step(const Scene& scene, const RunFolder& folder, int frame, int step) {
    InspectedStep out;
    out.frame = frame;
    out.simulation = start_simulation(scene);
    const ClothModel& model = out.simulation.model;
    out.steps = out.simulation.steps_per_frame;
    out.step = step == 0 ? out.steps : step;
    if (frame < 1)
        throw UsageError("--frame: there is no step before frame 1, the first that can be inspected");
    if (out.step > out.steps)
        throw UsageError(fmt::format("--step {}: a frame of this run has {} steps", out.step, out.steps));

    ComponentColors colors;
    const auto edges = drawn_edges(model);
    for (int k = 0; k < frame; ++k) {
        if (!std::filesystem::exists(folder.record(k))) {
            throw FolderError(fmt::format("'{}' holds {} frames; frame {} can't be inspected",
                                          folder.root.string(), k, frame));
        }
        const FrameRecord record =
            read_frame(folder, k, scene_hash(scene), model.size(), model.springs.size());
        colors.assign(record.component, edges);
        if (k + 1 == frame) restore(out.simulation, record);
    }
    for (int k = 0; k < out.step; ++k) {
        out.before = out.simulation.state;
        out.report = next_step(out.simulation);
    }
    out.simulation.frame = frame;
    out.record = present_record(out.simulation);
    out.colors = colors.assign(out.record.component, edges);
    out.components =
        component_table(model, out.record.component, out.record.springs, out.record.solves, out.colors);
    out.spring_force = forces_of(out);
    const ExtensionSprings& springs = model.springs;
    out.kappa.resize(springs.size());
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const double lighter = std::min(model.mass[springs.i[s]], model.mass[springs.j[s]]);
        out.kappa[s] = kappa(out.report.h, 1 / lighter, springs.stiffness[s], springs.damping[s]);
    }
    return out;
}

}  // namespace unravel::tool
