#pragma once

#include "sim/forces/bend.hpp"
#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Bend springs (sim/forces/bend.hpp): explicit, or with their Jacobian where the scheme gives them one.
extern const ForceTerm bending_term;

struct BendingMemory {
    BendLimit limit;
    std::vector<Vec3> force;  ///< (bend springs) N; empty where they are implicit, or evaluated along rows
    ImplicitBend implicit;    ///< empty where they are explicit
    bool is_implicit = false;
    Adjacency adjacency;  ///< empty where forces are gathered along rows
};

}  // namespace unravel::sim
