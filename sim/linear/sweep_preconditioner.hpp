#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/constraints/constraints.hpp"
#include "sim/linear/components.hpp"
#include "sim/linear/preconditioner.hpp"
#include "sim/linear/system.hpp"

namespace unravel::sim {

/// Preconditioners (E + Lo) E⁻¹ (E + Loᵀ) of 3 × 3 blocks, E the pivots and Lo strictly lower, applied by a
/// sweep down a component's rows and one up. Both are made of the matrix that constrained CG works with,
///   Â = S A S + c (I − S),
/// so that a sweep stays within the free directions:
///   ssor  symmetric Gauss–Seidel: E and Lo those of Â;
///   ic0   incomplete Cholesky without fill-in (Meijerink & van der Vorst 1977), in blocks.
/// Sequential within a component: the order of rows is part of the method.
struct SweepPreconditioner {
    struct Entry {
        std::uint32_t column;
        Mat3 block;
    };
    std::vector<Mat3> inverse;         ///< (rows) S E⁻¹ S [1/kg]
    std::vector<std::uint32_t> start;  ///< (rows + 1) of `lower`
    std::vector<Entry> lower;          ///< columns below the row's own, ascending
    std::vector<Vec3> carry;           ///< (rows) scratch of the upward sweep
};

/// Fills E and Lo with the blocks of Â; for ssor that is all.
///   blocks  constrained blocks of the same system: S (S C S + c (I − S))⁻¹ S
void build_sweeps(const System& A, const Components& components, const Constraints& constraints,
                  const BlockPreconditioner& blocks, SweepPreconditioner& out);

/// Turns rows [begin, end) of a component into its incomplete factors. A pivot that would not be positive
/// definite is replaced by the diagonal block itself.
void factorise(const System& A, const Components& components, const Constraints& constraints,
               std::uint32_t begin, std::uint32_t end, SweepPreconditioner& P);

/// z = P⁻¹ r on rows [begin, end) of a component; z is in the free directions. (rows)
void sweep(SweepPreconditioner& P, std::uint32_t begin, std::uint32_t end, std::span<const Vec3> r,
           std::span<Vec3> z);

}  // namespace unravel::sim
