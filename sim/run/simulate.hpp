#pragma once

#include <functional>
#include <optional>

#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/run/guard.hpp"
#include "sim/scene/scene.hpp"
#include "sim/step/step.hpp"

namespace unravel::sim {

/// A simulation under way: the model, where it stands, and the memory of its steps.
struct Simulation {
    ClothModel model;
    StepOptions options;
    Rate fps;
    int steps_per_frame = 1;               ///< the largest steps, where the step is adaptive
    std::optional<AdaptiveStep> adaptive;  ///< absent: every step is 1/(fps·steps_per_frame)
    ClothState state;
    int frame = 0;               ///< the last one reached
    std::uint64_t settling = 0;  ///< whole steps from its beginning to frame 0; 0 once it stands there
    StepWorkspace ws;
    Guard guard;
};

/// A simulation at the scene's start: frame 0, or where the scene begins to settle.
Simulation start_simulation(const Scene& scene);

/// Steps on to frame 0, where the scene settles before it. False where `keep_on`, asked before each step,
/// ends it. Throws SimulationError.
bool settle(
    Simulation& simulation, const std::function<bool()>& keep_on = [] { return true; });

/// Goes on from a record instead of from the start.
void restore(Simulation& simulation, const FrameRecord& record);

/// What the simulation stands at: its state, and what its last step was; before any step its first frame.
FrameRecord present_record(const Simulation& simulation);

/// One step on the way to the next frame. Throws SimulationError, after which the simulation stands where it
/// stood.
StepReport next_step(Simulation& simulation);

/// Steps to the next frame, from where it settles to frame 1. Frame k is reached at exactly k/fps: time is
/// counted in steps, not summed. Throws SimulationError, after which the simulation stands where the failing
/// step began, and Stopped.
FrameRecord next_record(Simulation& simulation);

/// Steps of a frame for a step size that divides it (checked when the scene is loaded).
int steps_per_frame(const Scene& scene);

}  // namespace unravel::sim
