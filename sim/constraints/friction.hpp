#pragma once

#include <span>
#include <vector>

#include "sim/constraints/contact.hpp"

namespace unravel::sim {

/// Coulomb friction between particles and solids.
///
/// A hold is a trial: a contact that seems to stick is constrained fully, and the step is solved. Where what
/// held it lies outside the cone, |R_t| > μ_s R_n, it slides, and the step is solved again. What is held is
/// therefore held by no more than friction can, whatever pulls: at a capstan's tension too.
///
/// What slides resists by an impulse J = −c v'_t with c = h μ_k N / max(|v_t|, v_ε), linear in the velocity v'
/// at the step's end: A_pp += c (I − n nᵀ), b_p −= c v_t. It can stop the particle and never turns it round.
/// The constraint takes the direction n out of the solve, so that c I does as well, with c z on the right to
/// leave the normal's row as it is: friction adds to a particle's inertia, and to nothing else.

/// Speed below which what slides creeps: friction is then short of Coulomb's [m/s].
inline constexpr double creep_speed = 1e-3;

/// Rounds of trials in a step, at most.
inline constexpr std::uint32_t most_trials = 10;

/// Before the first solve: which of the contacts are tried as held, and what resists the others' sliding.
void try_holds(std::span<const Solid> solids, const StepView& view, std::span<Touch> touches);

/// Puts friction into the system, in place of what it put there before.
///   v        (particles) what Δv is added to [m/s]
///   inertia  (particles) in front of Δv [kg]
///   impulse  (particles) b [kg·m/s]
void add_friction(std::span<const Vec3> v, const Constraints& constraints, std::span<Touch> touches,
                  std::span<double> inertia, std::span<Vec3> impulse);

/// Whether any touch slides, and friction resists it.
bool any_friction(std::span<const Touch> touches);

/// After a solve: lets go of what friction cannot hold, and takes the solve's own normal force and speed where
/// it was foreseen far off. True where the step is to be solved again.
///   reaction  (constraints) impulse of each, A Δv − b [kg·m/s]
///   v_end     (constraints) velocity of each one's particle as solved [m/s]
bool test_holds(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                std::span<const Vec3> reaction, std::span<const Vec3> v_end, std::span<Touch> touches);

/// After the last solve: releases contacts whose constraint force pulls, tries those that friction has
/// stopped as held from the next step on, and writes the contacts for it.
void judge_touches(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                   std::span<const Vec3> reaction, std::span<const Vec3> v_end, std::span<Touch> touches,
                   std::vector<Contact>& out);

}  // namespace unravel::sim
