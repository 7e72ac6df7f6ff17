#pragma once

#include <span>
#include <vector>

#include "sim/forces/extension.hpp"
#include "sim/model/state.hpp"
#include "sim/scene/math.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// What every scheme of the paper's Sec. 3 comes down to: one derivative at the end of the step, of weight h̃,
/// on top of what is known,
///   x' = x̃ + h̃ v',    M v' = M ṽ + h_f f* + h̃ [K (x' − x*) + D (v' − v*)],
/// with f* = f(x*, v*), K = ∂f/∂x and D = ∂f/∂v of the implicit springs at (x*, v*). Explicit springs have no
/// K and D, so that (x*, v*) is also where they are evaluated. Solved for δ = v' − v*:
///   (M − h̃ D − h̃² K) δ = M (ṽ − v*) + h_f f* + h̃ K (x̃ + h̃ v* − x*).
/// Backward Euler: x̃ = x* = x, ṽ = v* = v, h̃ = h_f = h, which is Eq. (5). Implicit springs may be linearised
/// at positions of their own in place of x*, explicit ones never.
struct Stage {
    double h = 0;                      ///< s, h̃
    double h_force = 0;                ///< s, h_f; differs from h̃ where f* stands for an old force too
    std::span<const Vec3> x, v;        ///< (particles) x̃ [m] and ṽ [m/s]
    std::span<const Vec3> x_at, v_at;  ///< (particles) x* [m] and v* [m/s]
    std::vector<Vec3> x_linear;  ///< (particles) where implicit springs are linearised [m]; empty: at x*
    /// What is none of the state's: memory for the spans above.
    struct Own {
        std::vector<Vec3> x, v, x_at, v_at;
    } own;
    /// Makes x* and v* the stage's own, to be changed.
    void own_at() {
        if (x_at.data() != own.x_at.data()) own.x_at.assign(x_at.begin(), x_at.end());
        if (v_at.data() != own.v_at.data()) own.v_at.assign(v_at.begin(), v_at.end());
        x_at = own.x_at;
        v_at = own.v_at;
    }
};

/// A time stepping scheme. A new one is its file, its line in scheme_of(), and its test.
struct Scheme {
    const char* name;
    int order;  ///< of convergence where the forces are smooth
    /// Which κ (7) each family bears explicitly; `threshold` is the adaptive schemes', and bending's wherever
    /// some of it may be explicit and some not.
    Splitting (*splitting)(double threshold);
    /// Fills the stage of a step of h seconds.
    void (*begin)(const ClothState& state, double h, Stage& stage);
    bool iterates = false;   ///< linearises again until (x*, v*) is the end of the step (Newton)
    bool multistep = false;  ///< reads the state's x_previous, v_previous and h_previous
    /// h²λ + 2hμ that explicit springs may reach, λ and μ eigenvalues of M⁻¹K and M⁻¹D; see
    /// explicit_limit.hpp.
    double explicit_bound = 4;
};

/// The scheme of a choice.
const Scheme& scheme_of(Integrator choice);

extern const Scheme forward_backward_euler, backward_euler, newton_euler, fixed_imex, adaptive_imex, bdf2,
    sbdf2;

/// Thresholds that put every spring on one side, whatever its κ.
inline constexpr double always_implicit = -1.0;
inline constexpr double always_explicit = 1e300;

/// Eq. (5)'s stage, shared by the schemes built on it.
void begin_euler(const ClothState& state, double h, Stage& stage);

/// The stage of the variable-step two-step backward differentiation formula; see bdf2.cpp.
void begin_bdf2(const ClothState& state, double h, Stage& stage);

}  // namespace unravel::sim
