#pragma once

#include <vector>

#include "sim/run/simulate.hpp"
#include "sim/step/trace.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/cached_run.hpp"
#include "tool/report/component_table.hpp"

namespace unravel::tool {

/// One step of a run, simulated again with everything that it computed on the way.
struct InspectedStep {
    int frame = 0;          ///< the step is on the way to this frame
    int step = 0;           ///< 1 … steps of the frame
    int steps = 0;          ///< of the frame
    ClothState before;      ///< what the step started from, and A was made at
    Simulation simulation;  ///< after the step
    FrameRecord record;     ///< what a frame record would say of the step
    StepReport report;
    std::vector<Rgb> colors;         ///< (particles) as in the clip
    std::vector<double> kappa;       ///< (stretch and shear springs) κ of Eq. (7)
    std::vector<Vec3> spring_force;  ///< (stretch and shear springs) on i, where the step took forces [N]
    std::vector<ComponentRow> components;
    StepTrace trace() const { return trace_of(simulation.model, simulation.ws); }
};

/// Goes on from the record of the frame before to step `step` (0: the last) of frame `frame`: the same bits
/// as in the run. Throws FolderError where the folder holds no such frame, UsageError where the frame has no
/// such step.
InspectedStep inspect_step(const CachedRun& run, int frame, int step);

}  // namespace unravel::tool
