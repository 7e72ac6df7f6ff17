#pragma once

#include <span>
#include <vector>

#include "sim/constraints/contact.hpp"

namespace unravel::sim {

/// Coulomb friction between particles and solids.
///
/// What the solve shows to be inside the cone is held, and leaves the system: fully constrained, for as long
/// as what holds it stays within |R_t| ≤ μ_s R_n. A hold is a trial: what lies outside slides from the next
/// step on; where too much friction costs it a speed that matters, the step itself is solved again.
///
/// What begins to slide is resisted by h μ_k N against what held it, whatever speed it comes to. What slides
/// is resisted by an impulse J = −c v'_t with c = h μ_k N / max(|v_t|, v_ε), linear in the velocity v' at the
/// step's end: A_pp += c (I − n nᵀ), b_p −= c v_t, with v_t as the last two steps foresee it. It stops the
/// particle and never turns it round. The constraint takes the direction n out of the solve, so that c I does
/// as well, with c z on the right to leave the normal's row as it is: friction adds to a particle's inertia.
/// v_ε is what friction makes or stops in a step against the cloth's resistance K, A's own block: h μ_k N /
/// K, and creep_speed at most.
///
/// It is held again once a step has shown it stopped: friction alone could take what is left of its motion,
/// and what its springs would answer to that. Where speeds along the cloth tremble, friction that is reckoned
/// from the last one is too large in the mean: a taut strip just above its limit slides slower than it
/// should.

/// v_ε at most [m/s].
inline constexpr double creep_speed = 1e-3;

/// Times that a step is solved again for friction, at most.
inline constexpr std::uint32_t most_trials = 10;

/// What a solve has given each constraint, (constraints).
struct Reactions {
    std::vector<Vec3> impulse;   ///< A Δv − b, what holds it [kg·m/s]
    std::vector<Vec3> velocity;  ///< of its particle at the step's end [m/s]
    std::vector<Mat3> block;     ///< A's own of its particle, friction's part included [kg]
    void resize(std::size_t constraints) {
        impulse.resize(constraints);
        velocity.resize(constraints);
        block.resize(constraints);
    }
};

/// Before the first solve: which new contacts are tried as held, and what resists the others' sliding.
void try_holds(std::span<const Solid> solids, const StepView& view, std::span<Touch> touches);

/// Whether any touch slides, and friction resists it.
bool any_friction(std::span<const Touch> touches);

/// Puts friction into the system, in place of what it put there before.
///   v        (particles) what Δv is added to [m/s]
///   inertia  (particles) in front of Δv [kg]
///   impulse  (particles) b [kg·m/s]
void add_friction(std::span<const Vec3> v, const Constraints& constraints, std::span<Touch> touches,
                  std::span<double> inertia, std::span<Vec3> impulse);

/// What friction did to a particle that has come to velocity v [kg·m/s]; in the constraint's free directions.
inline Vec3 friction_impulse(const Touch& touch, const Constraint& constraint, const Vec3& v) {
    if (constraint.free == 0) return Vec3::Zero();
    return constraint.S * (touch.rub - touch.drag_added * (v - touch.velocity));
}

/// After a solve: lets go of what friction is far from holding, and lets slide by Coulomb's force what is
/// resisted by far more. True where the step is to be solved again.
bool test_holds(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                const Reactions& reactions, std::span<Touch> touches);

/// After the last solve: releases contacts whose constraint force pulls, lets slide what friction doesn't
/// hold, holds what it has stopped, and writes the contacts for the next step.
void judge_touches(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                   const Reactions& reactions, std::span<const Touch> touches, std::vector<Contact>& out);

}  // namespace unravel::sim
