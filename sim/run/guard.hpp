#pragma once

#include "sim/model/failure.hpp"
#include "sim/model/model.hpp"
#include "sim/step/step.hpp"

namespace unravel::sim {

/// What every step of a run is held to, so that it stops with the cause named instead of going on with
/// numbers that mean nothing. All are far beyond what a sound run reaches.
struct Guard {
    double strain = 10;          ///< of stretch springs, (l − L)/L
    double energy = infinite;    ///< J, of motion and height; grows by what is put in
    double residual = 0.1;       ///< relative, of a component that CG did not solve to its tolerance
    double total = infinite;     ///< J, motion, height and springs after the last step
    double rounding = infinite;  ///< J, what `total` may grow by in a step beyond what is put in

    static constexpr double infinite = std::numeric_limits<double>::infinity();
};

/// The guard of a run that starts at `start`. Strain may reach 10 beyond what the scene placed; energy of
/// motion and height twice what the run has to spend: springs, motion, a fall through the cloth's own
/// size, and being lifted onto a solid's skin. Energy in springs is not counted: a stiff spring that goes
/// taut within a long step holds much of it for that one step. A cloth that rests where nothing pulls has
/// nothing to spend: what its positions' last bits may hold is added. `h` [s] is the step that the springs'
/// energy is measured for.
Guard make_guard(const ClothModel& model, const ClothState& start, double h);

/// step(), taken back where its outcome breaks the guard. On SimulationError the state is what it was before.
///
/// One linearisation sees neither a spring that goes taut within the step nor one that turns: both are longer
/// at its end than the linear model has them, and energy has come from nowhere. A step after which there is
/// more of it than before, than what pins, moving solids, wind and temporary springs put in and than what
/// swings where springs are explicit (sim/step/energy_input.hpp), is therefore taken again, linearised until
/// its end is met (Eq. 4): the springs' energy is convex in x, so that backward Euler then only loses. Where
/// it gains notably even so, as cloth does that is thrown about a solid, it is divided, down to eighths, as
/// far as that makes it less. The report counts all attempts' work, and those undone as rejected.
StepReport guarded_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                        StepWorkspace& ws, Guard& guard);

}  // namespace unravel::sim
