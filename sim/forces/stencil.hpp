#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "sim/forces/extension.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// What one to four particles do to each other through one vector of theirs, y = Σ w_k x_k, handled
/// implicitly: the forces
///   f_k = −w_k (K δy + D δẏ),    K = along u uᵀ + across (I − u uᵀ),    D = the dampings likewise,
/// that answer a change of y and of ẏ = Σ w_k v_k from where the stencil was made. A spring of any number of
/// ends: A gets A_kl += w_k w_l (h² K + h D), b of Eq. (5) gets −h w_k K Σ w_l g_l (g: Load::drift). The
/// force at (x*, v*) itself is no part of it; as all forces, it is in Load::impulse.
///
///   vertex v on a face         w = (1, −α, −β, −γ), u the normal, `along` the contact's stiffness
///   edge on edge               w = (1−s, s, t−1, −t), likewise
///   friction there             the same w and u, damping_across = c: c (I − u uᵀ) on the relative velocity
///   friction on a solid        one particle, w = 1
///   bending ½ c |Σ w_k x_k|²   along = across = c; three particles of a line: w = (1, −2, 1)
///   energy E(|y|)              u = y/|y|, along = E″, across = E′/|y|: of both what is not negative
///   a spring                   w = (1, −1)
///
/// A stays positive definite since none of the four numbers is negative; a stiffness that is one is left out.
/// Stencils on the same particles add up, so that K and D may have any directions.
struct Stencil {
    std::array<std::uint32_t, 4> p{};  ///< particles, none twice
    std::uint32_t count = 0;           ///< how many of p and w there are, 1–4
    std::array<double, 4> w{};         ///< 0: that particle has no part in it, and is no neighbour
    Vec3 u{0, 0, 1};                   ///< unit
    double along = 0, across = 0;      ///< ≥ 0 [N/m]
    double damping_along = 0;          ///< ≥ 0 [N·s/m]
    double damping_across = 0;         ///< ≥ 0 [N·s/m]
};

/// Stencils of one kind as the linear algebra sees them, beside the springs (SpringFamily).
struct Stencils {
    std::span<const Stencil> list;
    /// (stencils) which of them are implicit; the others are not there. Empty: all are.
    std::span<const SpringState> state{};
    /// (particles) how far a particle moves without the solve from where these stencils were made [m]; empty:
    /// as the cloth's springs.
    std::span<const Vec3> drift{};

    bool is_implicit(std::size_t s) const { return state.empty() || state[s] == SpringState::implicit; }
};

struct CurvatureStencils;

/// What of a step's couplings is the cloths' own bending, for solvers that know it by the places on a grid.
struct BendCouplings {
    const CurvatureStencils* stencils = nullptr;
    std::span<const std::uint8_t> is_implicit;  ///< (curvature stencils)
    std::size_t arcs = 0;                       ///< Couplings::springs[arcs] are the bend springs
    std::size_t list = none;                    ///< Couplings::stencils[list] are those of `stencils`
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
};

/// All that couples the particles of a step to each other.
struct Couplings {
    std::span<const SpringFamily> springs;
    std::span<const Stencils> stencils{};
    const BendCouplings* bending = nullptr;  ///< null: nothing bends implicitly
};

}  // namespace unravel::sim
