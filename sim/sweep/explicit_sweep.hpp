#pragma once

#include <memory>
#include <string>

#include "base/stop.hpp"
#include "sim/constraints/contact.hpp"
#include "sim/model/model.hpp"
#include "sim/model/report.hpp"
#include "sim/model/state.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

/// Forward–backward Euler (paper Eq. 3) on grids, many short steps at once. Nothing is coupled, so a substep
/// needs no system: one pass over the rows of a cloth evaluates every spring once, hands its force to both
/// ends, and moves a row as soon as its last force has arrived, which is when the row itself has been passed:
/// all of its springs reach back by at most two rows.
///
/// Row j of substep s + 1 therefore needs rows up to j + 2 of substep s and no more. Several substeps follow
/// each other through the cloth two rows apart: a row that has come into the cache serves them all, and
/// threads take turns with groups of substeps without ever waiting for a whole pass. Each row's arithmetic is
/// the same whoever does it and when, so any number of threads gives the same bits.

/// Why a model can't be swept, so that every substep takes the long way: its cloths don't go by rows, a force
/// that acts on them has no version along rows, or a solid is a mesh. Empty: it can.
std::string why_not_swept(const ClothModel& model);

struct SweepMemory;

/// The sweep's tables and rows, kept between steps.
class ExplicitSweep {
public:
    ExplicitSweep();
    ~ExplicitSweep();
    ExplicitSweep(ExplicitSweep&&) noexcept;
    ExplicitSweep& operator=(ExplicitSweep&&) noexcept;

    /// Makes ready for substeps of h seconds of a model that can be swept; does nothing where it is so
    /// already. `forces` is as prepare_terms() left it for h.
    void prepare(const ClothModel& model, const ForceMemory& forces, double h);

    /// Takes a state through `substeps` substeps of the prepared size. Pins, contact with solids and air act
    /// in each as they do in step(). What was constrained in the last substep stays in `constraints`, and
    /// `touches` counts its contacts.
    /// Throws Stopped.
    ///   next  receives x, v and contacts; must not be `state`
    void run(const ClothModel& model, const ClothState& state, int substeps, StopFlag stop, ClothState& next,
             Constraints& constraints, std::uint32_t& touches);

private:
    std::unique_ptr<SweepMemory> memory_;
};

}  // namespace unravel::sim
