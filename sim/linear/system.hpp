#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/constraints/constraints.hpp"
#include "sim/forces/extension.hpp"
#include "sim/forces/stencil.hpp"
#include "sim/linear/components.hpp"
#include "sim/linear/symmetric.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Which stencils a particle is in, and what they couple it to.
struct StencilIndex {
    struct Entry {
        std::uint32_t list, stencil;  ///< lists[list].list[stencil]
        std::uint32_t slot;           ///< of its particles this one
    };
    std::vector<std::uint32_t> start;    ///< (particles + 1) of `entries`
    std::vector<Entry> entries;          ///< each particle's in the order of lists and stencils
    std::vector<std::uint32_t> columns;  ///< (3 × entries) of the rows' blocks
    std::vector<std::uint8_t> wanted;    ///< (particles) 0: no row is made of it here; empty: all are
};

/// A Δv = b of one step, rows in the order of its components, so that A is block diagonal (paper Fig. 5):
/// component c owns rows [components.start[c], components.start[c+1]). Rows of fully constrained particles
/// follow the components'; they are never solved, only multiplied once for their constraint force, and their
/// effect on the components' rows is already in b.
///   A = M − h ∂f/∂v − h² ∂f/∂x      (Eq. 5 times M, so that it is symmetric for unequal masses too)
struct System {
    /// A_rc = −(a I + w wᵀ): a spring's off-diagonal block.
    struct Entry {
        std::uint32_t column;
        double a;
        Vec3 w;
    };
    /// A_rc = K: all that stencils put there.
    struct Block {
        std::uint32_t column;
        Symmetric3 K;
    };
    std::vector<std::uint32_t> row_of;       ///< (particles)
    std::vector<std::uint32_t> start;        ///< (rows + 1) of `entries`
    std::vector<Entry> entries;              ///< off-diagonal blocks of springs
    std::vector<std::uint32_t> block_start;  ///< (rows + 1) of `blocks`; empty: no stencil is implicit
    std::vector<Block> blocks;               ///< off-diagonal blocks of stencils, each row's by column
    UntouchedVector<Mat3> diagonal;          ///< (rows) [kg]
    UntouchedVector<Vec3> b;                 ///< (rows) [kg·m/s]
    std::vector<std::uint8_t> elsewhere;     ///< (components) 1: assembled and solved elsewhere; empty: none
    StencilIndex stencils_of;                ///< scratch of assemble()
    std::size_t rows() const { return diagonal.size(); }
    bool has_blocks(std::uint32_t begin, std::uint32_t end) const {
        return !block_start.empty() && block_start[begin] < block_start[end];
    }
    std::span<const Block> blocks_of(std::uint32_t row) const {
        if (block_start.empty()) return {};
        return {blocks.data() + block_start[row], blocks.data() + block_start[row + 1]};
    }
};

/// What the step hands to the assembly besides what couples particles.
struct Load {
    std::span<const double> mass;   ///< (particles) kg
    std::span<const Vec3> impulse;  ///< (particles) b without the h K g of springs and stencils [kg·m/s]
    std::span<const Vec3> drift;    ///< (particles) g, how far a particle moves without the solve [m]
};

/// Assembles the system of a step of h seconds for what is implicit of `couplings`. Of components marked in
/// `elsewhere`, (components) or empty, only the rows of constrained particles are made; the rest of theirs is
/// left without a meaning.
void assemble(const Couplings& couplings, const Load& load, const Components& components,
              const Constraints& constraints, double h, System& out,
              std::span<const std::uint8_t> elsewhere = {});

/// Whether a row is to be solved in A.
inline bool solved_in(const System& A, const Components& components, std::size_t row) {
    if (A.elsewhere.empty()) return true;
    const std::int32_t c = components.label[components.order[row]];
    return c < 0 || A.elsewhere[static_cast<std::size_t>(c)] == 0;
}

/// (A y) of one row.
inline Vec3 row_times(const System& A, std::uint32_t row, std::span<const Vec3> y) {
    Vec3 sum = A.diagonal[row] * y[row];
    for (std::uint32_t e = A.start[row]; e < A.start[row + 1]; ++e) {
        const System::Entry& entry = A.entries[e];
        const Vec3& yc = y[entry.column];
        sum -= entry.a * yc + entry.w * entry.w.dot(yc);
    }
    for (const System::Block& block : A.blocks_of(row)) sum += block.K * y[block.column];
    return sum;
}

}  // namespace unravel::sim
