#pragma once

#include "sim/forces/bend.hpp"
#include "sim/forces/curvature.hpp"
#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Bending: stencils that are linear in curvature (sim/forces/curvature.hpp), and arcs (sim/forces/bend.hpp).
///
/// Each stencil is explicit where its own κ allows and implicit where not. Arcs are explicit, so that cloth
/// which is compressed couples nothing and falls into components; their slope at the onset of buckling is
/// then limited to what the step bears. Where the scheme treats all bending implicitly, or a stencil is
/// implicit, which couples compressed cloth in any case, they are implicit and keep the material's slope.
extern const ForceTerm bending_term;

/// Which stencils are implicit, decided for the settings of a step.
struct CurvatureSplit {
    ForceSettings settings;
    std::vector<std::uint8_t> is_implicit;  ///< (stencils)
    std::vector<Stencil> implicit;          ///< those that are, as the linear system takes them
};

struct BendingMemory {
    BendLimit limit;          ///< of arcs that are explicit
    BendLimit unlimited;      ///< of arcs that are implicit; empty where they are not
    std::vector<Vec3> force;  ///< (arcs) N; empty where they are implicit, or evaluated along rows
    ImplicitBend implicit;    ///< empty where arcs are explicit
    bool is_implicit = false;
    Adjacency adjacency;  ///< of arcs; empty where forces are gathered along rows
    CurvatureSplit split;
    CurvatureParts parts;    ///< empty where forces are gathered along rows
    std::vector<Vec3> pull;  ///< (stencils) c y [N]; likewise
    const BendLimit& acting() const { return is_implicit ? unlimited : limit; }
};

}  // namespace unravel::sim
