#include "tool/inspect/inspected.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tool/base/exit.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

InspectedStep inspect_step(const CachedRun& run, int frame, int step) {
    InspectedStep out;
    out.frame = frame;
    out.simulation = start_simulation(run.scene);
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
        if (!std::filesystem::exists(run.folder.record(k))) {
            throw FolderError(fmt::format("'{}' holds {} frames; frame {} can't be inspected",
                                          run.folder.root.string(), k, frame));
        }
        const FrameRecord record = run.read(k);
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
    out.spring_force = spring_forces(model, out.trace());
    const ExtensionSprings& springs = model.springs;
    out.kappa.resize(springs.size());
    for (std::size_t s = 0; s < springs.size(); ++s) {
        out.kappa[s] = kappa_between(out.report.h, model.mass[springs.i[s]], model.mass[springs.j[s]],
                                     springs.stiffness[s], springs.damping[s]);
    }
    return out;
}

}  // namespace unravel::tool
