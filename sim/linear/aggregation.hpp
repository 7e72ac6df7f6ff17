#pragma once

#include <span>
#include <vector>

#include "sim/constraints/constraints.hpp"
#include "sim/linear/aggregates.hpp"
#include "sim/linear/aggregation_level.hpp"
#include "sim/linear/components.hpp"
#include "sim/linear/system.hpp"

namespace unravel::sim {

/// A multigrid cycle by aggregation as preconditioner of a large component on any mesh, in single precision:
///
///   z  = M⁻¹ r
///   z += S P C (Pᵀ S (r − A z))     the same on aggregates (sim/linear/aggregates.hpp), down to a handful
///   z += M⁻¹ (r − A z)
///
/// P is one translation per aggregate, and coarse matrices are Pᵀ A P, summed anew from the springs that act
/// in this step: springs between two aggregates are one coupling, springs within one are gone.
///
/// Where stencils couple the component too, a coupling is a general block, on the finest level as well, and
/// need not be positive. The bound below holds for any L; what M leaves out is then added to D as a diagonal
/// that is not below it.
///
/// M = (E + L) E⁻¹ (E + Lᵀ) is the incomplete factorisation without fill that changes the diagonal alone
/// (Meijerink & van der Vorst 1977): E_i = D_i − θ_i T_i, T_i = Σ L_ij E_j⁻¹ L_ijᵀ over the j before i. With
/// θ = 1 it solves lines of springs exactly, across whatever mesh they run; cloth, far stiffer along threads
/// than across, needs that. But where springs of several directions meet it may overshoot. From
///   2 M − A = D + L + Lᵀ + 2 L E⁻¹ Lᵀ − 2 θ T ≥ D/2 − 3/2 θ T,    since L + Lᵀ + 2 L E⁻¹ Lᵀ ≥ −E/2,
/// it never does where D_i ≥ 3 θ_i T_i: θ_i is the largest of a few values that are found so. Couplings that
/// M leaves out (between pieces that are swept at once) are added to its D: A only becomes smaller by them
/// (Baker, Falgout, Kolev & Yang 2011). So the cycle is symmetric and positive definite.
///
/// Constraints: E⁻¹ is in the free directions, as a constrained block's inverse is
/// (sim/linear/preconditioner.hpp). Fully constrained particles are absent: springs to them hold the
/// aggregate of their other end. An aggregate is held by 2 tr(D_i) (I − S_i) for each partly constrained
/// member, which bounds A from above, within a factor of two, whatever its members' directions.
class Aggregation {
public:
    /// Sets up for component c of A, whose particles `aggregates` knows; constraint (rows), null: free.
    void build(const System& A, const Components& components, std::size_t c, const Aggregates& aggregates,
               std::span<const Constraint* const> constraint);
    /// z = M⁻¹ r on the component's rows; r in the free directions, z then is. (rows of A)
    void apply(std::span<const Vec3> r, std::span<Vec3> z);

private:
    using Fine = AggregationLevel<RankOneBlock>;
    using Coarse = AggregationLevel<Block3>;
    template <typename Finest>
    void place(const System& A, const Components& components, std::size_t c, const Aggregates& aggregates,
               Finest& finest);
    void load_row(const System& A, std::uint32_t r, std::uint32_t i, Fine& level) const;
    void load_row(const System& A, std::uint32_t r, std::uint32_t i, Coarse& level) const;
    template <typename Finest>
    void load(const System& A, std::span<const Constraint* const> constraint, Finest& finest);
    template <typename Finest>
    void build_on(Finest& finest, const System& A, const Components& components, std::size_t c,
                  const Aggregates& aggregates, std::span<const Constraint* const> constraint);
    Float4 filtered(std::uint32_t i, const Float4& y) const;
    template <typename Level>
    void cycle(Level& level, std::size_t depth);
    template <typename Finest>
    void apply_on(Finest& finest, std::span<const Vec3> r, std::span<Vec3> z);

    std::uint32_t begin_ = 0;
    std::vector<std::uint32_t> particles_;  ///< of the component that the places below are for
    std::vector<std::uint32_t> row_;        ///< (fine rows) row of A, counted from the component's first
    std::vector<std::uint32_t> at_;         ///< (component's rows) the other way round
    std::vector<std::uint32_t> found_;      ///< (nodes of a level) scratch
    /// (fine rows) free, absent, or which of filters_ holds S
    std::vector<std::int32_t> filter_;
    std::vector<Block3> filters_;
    Fine springs_;    ///< the finest level, of springs alone
    Coarse general_;  ///< or of general blocks
    bool of_stencils_ = false;
    std::vector<Coarse> coarse_;
    std::size_t depth_ = 0;  ///< levels of coarse_ in use
};

}  // namespace unravel::sim
