#pragma once

#include <cstddef>
#include <cstdint>

namespace unravel::sim {

/// One grid as the kernels see it, coarse or fine. A field of c numbers per node holds, for each row of the
/// grid, c runs of `pitch` floats, one per number: number k of node (i, j) is at [(j·c + k)·pitch + margin +
/// i]. All that lies outside the grid is zero in every field, but for the column on either side of it where a
/// tube closes. Rows are allocated in eights.
///
/// What joins nodes are the four directions of sim/forces/grid_springs.hpp, each block held by its upper
/// left node: `couplings` has 4 × (4 or 6) numbers per node, direction by direction; a block that leaves the
/// grid is zero.
struct StencilGrid {
    static constexpr int margin = 8;
    int nu = 0, nv = 0;
    int pitch = 0;
    bool tube = false;
    bool diagonals = true;  ///< false: no block of the two diagonal directions is other than zero
    const float* couplings = nullptr;
    const float* self = nullptr;  ///< what a node has for itself: its mass (1 number), or a block (6), coarse
    const std::int32_t* slot =
        nullptr;  ///< (1 number per node) free, masked, or the number of its directions
    const double* directions =
        nullptr;  ///< (partly constrained, 6) its free directions, unit; the second or 0
    /// (3 numbers per node) bending that is linear in curvature (sim/forces/curvature.hpp), h² c [kg]: of the
    /// curvature along u and along v through a node, and of the twist of the cell whose upper left it is;
    /// zero where it leaves the grid. Null: none.
    const float* bends = nullptr;
    int columns() const { return (nu + 7) / 8 * 8; }
};

/// `slot` of a node that moves freely, and of one that the solve leaves where it is.
inline constexpr std::int32_t free_slot = -1, masked_slot = -2;

/// Scratch of a sweep over a band of rows: rows of `pitch` floats, or doubles for the residual.
inline constexpr int sweep_scratch_rows = 21;

// The inner loops of the grid solver. Each works on rows [begin, end) of a grid, or columns, and writes
// nothing else; sums are per row, so that the way the grid is cut into bands changes no bit. Of two entries
// the first is for the grid itself, whose couplings are springs, the second for coarser ones.

struct SweepKernels {
    /// p' = z + β p, q = A p', dots[j] = p'·q of row j. p and p' differ.
    void (*direction)(const StencilGrid&, int begin, int end, float beta, const float* z, const float* p,
                      float* p_next, float* q, double* dots, float* scratch);
    /// x += α p, r −= α q, z = P r where z is not null, dots[j] = r·P r. `P` has 6 numbers per node.
    void (*advance)(const StencilGrid&, int begin, int end, float alpha, const float* p, const float* q,
                    float* x, float* r, const float* P, float* z, double* dots);
    /// r = b − A x, filtered, in double; dots[j] = r·P r. b and x are fields of doubles, x's rings closed.
    void (*residual)(const StencilGrid&, int begin, int end, const double* b, const double* x, const float* P,
                     float* r, double* dots, double* scratch);
    /// t = r − A z, filtered; z's rings are closed.
    void (*defect[2])(const StencilGrid&, int begin, int end, const float* r, const float* z, float* t,
                      float* scratch);
    /// D, the blocks of A on its diagonal. 6 numbers per node.
    void (*diagonal[2])(const StencilGrid&, int begin, int end, float* D);
};

struct LineKernels {
    /// P = S (S D S + c (I − S))⁻¹ S: D⁻¹ within the free directions.
    void (*invert)(const StencilGrid&, int begin, int end, const float* D, float* P);
    /// Factors of the lines along v in columns [begin, end), multiples of eight, from D: 6 numbers per node.
    void (*factor_v[2])(const StencilGrid&, int begin, int end, const float* D, float* E);
    /// z = (add ? z : 0) + (lines along v)⁻¹ t, columns [begin, end). Destroys t.
    void (*solve_v[2])(const StencilGrid&, int begin, int end, const float* E, float* t, float* z, bool add);
    /// Factors of the lines along u of rows 8·block to 8·block + 7, turned so that these rows are lanes: per
    /// column the factor's 6 numbers and the 4 or 6 of the coupling to the next, each of eight lanes. A ring
    /// is cut at its end.
    void (*factor_u[2])(const StencilGrid&, int block, const float* D, float* lines);
    /// z = (add ? z : 0) + (lines along u)⁻¹ t. `scratch` holds 24 floats per column.
    void (*solve_u[2])(const StencilGrid&, int block, const float* lines, const float* t, float* z, bool add,
                       float* scratch);
};

/// Between a grid and the one of its aggregates of 2 × 2, bilinear. `scratch` holds 2·pitch + 64 floats.
struct TransferKernels {
    /// r = Pᵀ t on rows [begin, end) of the coarse grid.
    void (*restrict_to)(const StencilGrid& fine, const StencilGrid& coarse, int begin, int end,
                        const float* t, float* r, float* scratch);
    /// z += S P e on rows [begin, end) of the fine grid.
    void (*prolong_add)(const StencilGrid& fine, const StencilGrid& coarse, int begin, int end,
                        const float* e, float* z, float* scratch);
    /// Copies the columns beside the grid where a tube closes.
    void (*close_rings)(const StencilGrid&, int begin, int end, float* z);
};

/// K, the part of A that bending has (StencilGrid::bends): sweeps of their own, after those of SweepKernels.
struct BendKernels {
    /// q += S K p, dots[j] += p·K p of row j; p = S p.
    void (*add)(const StencilGrid&, int begin, int end, const float* p, float* q, double* dots,
                float* scratch);
    /// t −= S K z
    void (*take)(const StencilGrid&, int begin, int end, const float* z, float* t, float* scratch);
    /// out = b − K x, in double; out may be b.
    void (*take_in_double)(const StencilGrid&, int begin, int end, const double* b, const double* x,
                           double* out, double* scratch);
    /// D += the blocks of K on its diagonal; or what half the sum of the sizes of a row's entries is beyond
    /// that: with it the diagonal alone, taken twice, is no less than K. 6 numbers per node.
    void (*diagonal[2])(const StencilGrid&, int begin, int end, float* D);
    /// Of the grid of 2 × 2 aggregates: its bends, a quarter of the mean of four for the doubled distance;
    /// and what masked nodes hold an aggregate with by bending, to its own block.
    void (*coarsen)(const StencilGrid& fine, const StencilGrid& coarse, int begin, int end, float* bends,
                    float* self);
};

struct CoarsenKernels {
    /// Rows [begin, end) of the grid of 2 × 2 aggregates of `fine`: couplings (24 numbers per node), own
    /// blocks (6), slots and what is active (1 or 0). D is the fine grid's diagonal. A coarse coupling is
    /// half the sum of the active fine ones that cross between two aggregates.
    void (*coarsen[2])(const StencilGrid& fine, const float* D, const float* active,
                       const StencilGrid& coarse, int begin, int end, float* couplings, float* self,
                       std::int32_t* slot, float* coarse_active);
};

/// One build of them all. Every build gives the same bits.
struct StencilKernels {
    const char* name;
    const SweepKernels& sweep;
    const LineKernels& line;
    const TransferKernels& transfer;
    const CoarsenKernels& coarsening;
    const BendKernels& bending;
};

/// The best that this machine runs.
const StencilKernels& stencil_kernels();
/// The one for any x86-64.
const StencilKernels& plain_stencil_kernels();

}  // namespace unravel::sim
