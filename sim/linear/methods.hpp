#pragma once

#include "sim/linear/component_rows.hpp"

namespace unravel::sim {

/// A preconditioner M of constrained CG on rows: how it is built and how it is applied. To add one, write the
/// two and a line in the list of methods.cpp.
struct PreconditionerMethod {
    Preconditioner kind;
    /// For all rows at once, into the workspace, whose constrained blocks are there already; or null.
    void (*build_all)(const System& A, const Components& components, const Constraints& constraints,
                      SolveWorkspace& ws);
    /// For one component, before it is first applied to it; or null.
    void (*build)(const ComponentRows& rows);
    /// q = M⁻¹ r on the component's rows; r in the free directions, q then is. The vectors are the
    /// workspace's.
    void (*apply)(const ComponentRows& rows);
};

/// The method of that word; the constrained block's for words that no method on rows has.
const PreconditionerMethod& method_of(Preconditioner kind);

}  // namespace unravel::sim
