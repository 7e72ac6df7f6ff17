#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/extension.hpp"

namespace unravel::sim {

/// Particles gathered into ever larger aggregates along the cloth's springs, whatever shape it has. Made
/// once, from what is joined at rest and how stiffly, so that it depends on no state.
struct Aggregates {
    static constexpr std::uint32_t none = 0xffffffffu;
    /// Two particles that are joined besides by the cloth's own springs: stitches.
    struct Join {
        std::uint32_t i, j;
        double stiffness;
    };
    std::vector<std::uint32_t> order;  ///< (particles) level 0 in the order in which sweeps walk
    /// (levels − 1)(nodes of the level) which node of the next level each belongs to. A level counts its
    /// nodes as its first members come in the level above.
    std::vector<std::vector<std::uint32_t>> parent;
    std::size_t particles() const { return order.size(); }
};

/// Orders the particles as Cuthill & McKee (1969) do, so that lines of springs run onwards and neighbours are
/// near in memory however a mesh is numbered. Then matches pairs along the stiffest springs, and pairs of
/// pairs by how many springs join them (Notay 2010), which on a grid of quads gives 2 × 2 blocks; a node that
/// nobody took joins the aggregate it has most springs to. Until a level is small, or grows no smaller.
Aggregates make_aggregates(std::size_t particles, const ExtensionSprings& springs,
                           std::span<const Aggregates::Join> joins);

}  // namespace unravel::sim
