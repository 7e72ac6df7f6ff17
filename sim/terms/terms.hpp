#pragma once

#include <array>

#include "sim/terms/air.hpp"
#include "sim/terms/bending.hpp"
#include "sim/terms/cloth_contact.hpp"
#include "sim/terms/gravity.hpp"
#include "sim/terms/springs.hpp"
#include "sim/terms/stitches.hpp"
#include "sim/terms/term.hpp"

namespace unravel::sim {

/// Every force that a scene may call for. Those by springs act, and enter the linear system, in this order.
inline constexpr std::array<const ForceTerm*, 6> scene_terms{
    &spring_term, &bending_term, &gravity_term, &stitch_term, &self_collision_term, &air_term};

/// What terms keep between steps, for its memory or to be read.
struct ForceMemory {
    ExtensionForces springs;  ///< of those evaluated along rows there is only the state
    BendingMemory bending;
    AirMemory air;
    StitchMemory stitches;
    SelfCollisionWorkspace self_collision;
};

/// Calls f(term) for each that acts on a model: those of scenes, then the model's own.
template <typename F>
void each_term(const ClothModel& model, const F& f) {
    for (const ForceTerm* const term : scene_terms) {
        if (term->acts(model)) f(*term);
    }
    for (const ForceTerm* const term : model.further_terms) {
        if (term->acts(model)) f(*term);
    }
}

/// Makes what depends on the size of a step, of every term that acts, where it isn't there already.
void prepare_terms(const ClothModel& model, double h, ForceMemory& memory);

/// −∂E/∂x of all energy that is measured, at x and at rest: to `force` [N]. (particles)
void conservative_forces(const ClothModel& model, std::span<const Vec3> x, ForceMemory& memory,
                         std::span<Vec3> force);

}  // namespace unravel::sim
