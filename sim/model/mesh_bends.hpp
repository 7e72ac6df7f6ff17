#pragma once

#include <span>
#include <vector>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// What a mesh cloth is made of at its vertices and between them; the last region that holds all decides.
class MeshMaterials {
public:
    explicit MeshMaterials(const Cloth& cloth);
    const Material& at(std::span<const std::uint32_t> vertices) const;
    double density(std::uint32_t vertex) const;

private:
    bool all_inside(std::size_t region, std::span<const std::uint32_t> vertices) const;

    const Cloth& cloth_;
    std::vector<std::vector<char>> inside_;  // (regions, vertices)
};

/// A bend spring to be: a strip of cloth, laid flat.
struct BendStrip {
    std::uint32_t a, middle, b;  ///< vertices; `middle` is no_index where the strip crosses an edge
    double rest;                 ///< m, from a to b
    double width;                ///< m, such that k_b = B · width
};

/// The strips around every vertex with quads, and across every edge of two triangles (mesh_springs.hpp).
/// Strips of n directions around a vertex share its area: with width w = area/(half the strip's length), each
/// has 4 w/(3 n), for Σ cos⁴ over n directions is 3 n/8.
std::vector<BendStrip> bend_strips(const MeshCloth& mesh);

}  // namespace unravel::sim
