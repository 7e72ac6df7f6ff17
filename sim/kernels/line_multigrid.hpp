#pragma once

#include <vector>

#include "sim/kernels/grid_system.hpp"

namespace unravel::sim {

/// A multigrid cycle as preconditioner of a large component. A spring of cloth is 50 to 1,000 times stiffer
/// along its thread than across, so that neither relaxing node by node nor coarsening alone gets anywhere;
/// solving whole lines along both thread directions exactly does, and a coarse grid removes the rest:
///
///   z  = L_u⁻¹ r             lines along u          (block tridiagonal: sim/kernels/line_solves.cpp)
///   z += L_v⁻¹ (r − A z)     lines along v
///   z += S P C (Pᵀ (r − A z))  the same on aggregates of 2 × 2, down to a handful of nodes
///   z += L_v⁻¹ (r − A z)
///   z += L_u⁻¹ (r − A z)
///
/// symmetric positive definite as it stands: with A = L − N, L + N is positive definite for any set of lines,
/// since every spring puts (p_a + p_b)ᵀ B (p_a + p_b) ≥ 0 into it. P is bilinear. A coarse coupling is the
/// sum of the fine ones that cross between two aggregates, halved for the doubled distance; a node's own
/// block sums masses, what springs to masked nodes hold it with, and c (I − S) for partly constrained ones.
///
/// Bending that is linear in curvature has no place in a line's blocks. Lines hold it as a diagonal of half
/// the sum of its entries' sizes, of which L + N is positive definite again; defects have the whole of it on
/// every level.
class LineMultigrid {
public:
    /// Sets up for `system`, which must outlive the use.
    void build(const GridSystem& system);
    /// z = M⁻¹ r; fields of 3. Reads no more of r than the component's rows. Destroys nothing but z.
    void apply(const float* r, float* z);

private:
    struct Level {
        StencilGrid grid;
        std::vector<float> couplings, self, active, D, bends, lines_u, lines_v;
        std::vector<std::int32_t> slot;
        std::vector<float> r, z, t;
        const float* diagonal = nullptr;
    };
    void set_up(Level& level, int kind);
    void relax_u(Level& level, int kind, const float* t, float* z, bool add);
    void relax_v(Level& level, int kind, float* z);
    void find_defect(Level& level, int kind, const float* r, float* z);
    void cycle(std::size_t depth, const float* r, float* z);

    const GridSystem* system_ = nullptr;
    std::vector<Level> levels_;
    std::size_t depth_ = 0;
};

}  // namespace unravel::sim
