#pragma once

#include "sim/model/failure.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/picture/clip.hpp"

namespace unravel::tool {

/// Leaves in RUN/failure/ all that is needed to understand why a run stopped, and to go on from there:
///   failure.json     which step, criterion, particles and spring; numbers; what to change
///   scene.toml       the scene as run
///   last_good.state  the state from which the failing step started, a frame record
///   worst.png        that state with the particles marked that failed, where it can be drawn
/// Throws OutputError.
void write_failure(const RunFolder& folder, const Scene& scene, std::uint64_t scene_hash,
                   const Simulation& simulation, const SimulationError& error, const ClipOptions& options);

}  // namespace unravel::tool
