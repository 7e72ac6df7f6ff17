#pragma once

#include "sim/constraints/contact.hpp"
#include "sim/self_collision/surface_contact.hpp"

namespace unravel::sim {

/// Contact of edges and faces of the cloth with solids, between particles: where the inside of an edge or of
/// a triangle would come nearer to a solid than half its offset, and nearer than its corners, the nearest
/// point gets a stiff damped spring along the solid's normal and friction across it, relative to the solid,
/// as between layers (surface_contact.hpp). Two or three particles are coupled by it. What particles meet
/// stays their constraint. Only of solids that say so, and of a closed form, which are all convex, so that
/// the nearest point of an edge can be told from the slopes at its ends.
///
/// Adds to the contacts of the step; foreseen is where the step of h seconds would end without them.
void find_solid_contacts(const ClothModel& model, const SolidPoses& poses, std::span<const Vec3> x,
                         std::span<const Vec3> v, std::span<const Vec3> foreseen, double h, double threshold,
                         SurfaceContactWorkspace& ws);

/// After the step: what is inside a solid even so, at the points that touched it, is put out to its surface,
/// and no longer moves into it.
void keep_edges_outside(const ClothModel& model, const SolidPoses& poses, const Constraints& constraints,
                        double h, const SurfaceContactWorkspace& ws, std::span<Vec3> x, std::span<Vec3> v);

}  // namespace unravel::sim
