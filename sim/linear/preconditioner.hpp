#pragma once

#include <cstdint>
#include <vector>

#include "sim/constraints/constraints.hpp"
#include "sim/linear/system.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Block-diagonal preconditioners with the constraint filter S folded in, so that CG applies no filter of its
/// own. Of the constrained block P = S C + I − S (Eq. 11) only its action on range(S) is ever used, and that
/// is
///   P⁻¹ S = S (S C S + c (I − S))⁻¹ S    for any c > 0,
/// a symmetric 3 × 3 block per row. The others: S (none), S diag(A)⁻¹ S (diagonal), S C⁻¹ S (block).
struct BlockPreconditioner {
    UntouchedVector<Mat3> inverse;  ///< (rows) [1/kg]
};

/// Builds `kind` (one of none, diagonal, block, constrained_block) for all rows of the components.
void build_preconditioner(Preconditioner kind, const System& A, const Components& components,
                          const Constraints& constraints, BlockPreconditioner& out);

}  // namespace unravel::sim
