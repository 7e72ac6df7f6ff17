#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/stop.hpp"
#include "sim/constraints/constraints.hpp"
#include "sim/linear/aggregates.hpp"
#include "sim/linear/components.hpp"
#include "sim/linear/preconditioner.hpp"
#include "sim/linear/solver_choice.hpp"
#include "sim/linear/sweep_preconditioner.hpp"
#include "sim/linear/system.hpp"

namespace unravel::sim {

class Aggregation;

struct SolveOptions {
    Preconditioner preconditioner = Preconditioner::constrained_block;
    double tolerance =
        1e-3;  ///< on ‖r‖ / ‖Sb‖, both in the norm of P⁻¹ (constrained block), for every preconditioner
    int max_iterations = 2000;  ///< per component
    StopFlag stop = nullptr;    ///< heeded in every iteration, and by who calls the solver in every step
};

/// What solving one component took.
struct ComponentSolve {
    std::uint32_t iterations = 0;
    std::uint64_t rvm = 0;  ///< row–vector multiplies: rows × products with A, the first residual's included
    double residual = 0;    ///< relative, as SolveOptions::tolerance measures it
    bool converged = true;
    SolvedBy by = SolvedBy::nothing;
    SolveReason because = SolveReason::nothing_implicit;
};

/// Memory of the solver, kept between steps.
struct SolveWorkspace {
    BlockPreconditioner constrained_blocks;     ///< whatever the preconditioner: they measure residuals
    BlockPreconditioner blocks;                 ///< of none, diagonal and block
    SweepPreconditioner sweeps;                 ///< of ssor and ic0
    std::vector<Vec3> x;                        ///< (rows)
    UntouchedVector<Vec3> r, p, q;              ///< (rows)
    std::vector<double> partials;               ///< (chunks of rows)
    std::vector<const Constraint*> constraint;  ///< (rows) null: free
    /// Of all particles, made once by who knows the cloth's springs; empty: no component gets cycles.
    Aggregates aggregates;
    std::vector<std::shared_ptr<Aggregation>> aggregations;  ///< one per component that may get them
    std::vector<Aggregation*> aggregation_of;                ///< (components) or null
};

/// Rows from which a component is large enough for aggregation; none is for other preconditioners.
inline std::uint32_t least_rows_of_aggregation(Preconditioner kind) {
    return kind == Preconditioner::aggregation ? 64u
           : kind == Preconditioner::automatic ? 4096u
                                               : 0xffffffffu;
}

/// Solves Sx = Sb, (I − S)x = (I − S)z (Eq. 9) by modified preconditioned conjugate gradients (Baraff &
/// Witkin 1998, Sec. 5.3) from x₀ = S y + (I − S) z (Ascher & Boxerman 2003), y = `guess`: each component is
/// a task of its own on its own rows; a large one is cut into chunks of rows besides. Result in ws.x, in row
/// order; rows of the fully constrained hold z. A component of one row is solved directly and counts as one
/// iteration of one multiply. Components that A leaves to others are passed over. Preconditioners that need a
/// grid (stencil_block, multigrid) are the constrained block here. A large component gets cycles by
/// aggregation where `aggregation` asks for them, or where `automatic` expects the constrained block to take
/// long; if one takes longer than it was expected to, the other takes over, once. Throws Stopped.
///   guess   (particles)   [m/s]
///   out     (components)
void solve(const System& A, const Components& components, const Constraints& constraints,
           std::span<const Vec3> guess, const SolveOptions& options, SolveWorkspace& ws,
           std::vector<ComponentSolve>& out);

}  // namespace unravel::sim
