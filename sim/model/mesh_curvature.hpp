#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/mesh/mesh_cloth.hpp"

namespace unravel::sim {

/// A curvature stencil of a mesh laid flat (sim/forces/curvature.hpp).
struct MeshCurvature {
    std::uint32_t count = 0;              ///< 3 or 4
    std::array<std::uint32_t, 4> vertex;  ///< of a run the one that it goes through is the second
    std::array<double, 4> weight;
    double stiffness;  ///< c/B [1/m²]
};

/// The stencils of a mesh: of every run of cloth that goes on straight through a vertex, from an edge to the
/// vertex or the edge opposite; of the twist of every quad; and of the hinge at every edge of two triangles.
///
/// A stencil sees one component T : κ of the curvature κ, T = ½ Σ w_k X_k X_kᵀ of its places X laid flat.
/// Round each vertex constants c ≥ 0 are sought with Σ c (T : κ)² = B κ : κ times the vertex's area for every
/// κ, the energy of a plate without Poisson's effect, as on grids: a cylinder of any direction has ½ B κ² per
/// area. They are the solution of least squares where none is exact. On a mesh that is a grid they are the
/// grid's.
std::vector<MeshCurvature> curvature_of(const MeshCloth& mesh);

}  // namespace unravel::sim
