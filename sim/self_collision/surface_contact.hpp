#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/stencil.hpp"
#include "sim/model/contact_model.hpp"
#include "sim/surface/closest.hpp"
#include "sim/surface/pair_watch.hpp"

namespace unravel::sim {

/// Contact of cloth with cloth between surfaces. Where a vertex and a triangle, or two edges, would come
/// nearer than the cloths' thickness, the vector between their nearest points, r = Σ w_k x_k, gets a stiff
/// damped spring along its direction n, and friction across it:
///   f = k (thickness − n·r) n − d (n·ṙ) n − c (I − n nᵀ) ṙ,     c = μ N / max(|(I − n nᵀ) ṙ|, slow).
/// That is Coulomb's friction with its direction taken from the end of the step and its size from the start
/// (semi-implicit, as Bridson, Fedkiw & Anderson 2002, Sec. 6, has it for impulses): what would slide slower
/// than `slow` is at rest but for a creep. Each contact is a stencil of four particles that enters the
/// splitting, the components and the matrix; one that would not be closed at the step's end is not there.
struct SurfaceContact {
    Stencil stencil;      ///< r, n, k, d and c
    Vec3 force{0, 0, 0};  ///< f at the start of the step, on r [N]
    SpringState state = SpringState::implicit;
    std::int32_t solid = -1;  ///< that the cloth touches; −1: cloth
};

/// What is kept between surfaces within a step, as a share of the thickness.
inline constexpr double kept_share = 0.1;

/// Memory of contact between surfaces, kept between steps.
struct SurfaceContactWorkspace {
    std::shared_ptr<const ContactModel> model;  ///< that `tree` is of
    SurfaceTree tree;                           ///< the model's, with the boxes of the last search
    FeaturePairs pairs;                         ///< that can touch while every particle stays in its box
    PairWatch watch;                            ///< which of them may do so in a step
    std::vector<Box> boxes;      ///< (particles) of the last search, less what reaches beyond them
    std::vector<Vec3> searched;  ///< (particles) where they were then [m]
    std::vector<double> margin;  ///< (particles) m, of `boxes` around the way that they seemed to go

    std::vector<Stencil> stencils;    ///< (contacts) of this step
    std::vector<Vec3> force;          ///< (contacts) on r, at the start [N]
    std::vector<SpringState> state;   ///< (contacts)
    std::vector<std::int32_t> solid;  ///< (contacts) −1: cloth
    Lists at;                         ///< of each particle: 4 × contact + place among its particles
    double least_distance = 0;        ///< m, of features that may touch, at most the largest thickness
    std::vector<std::vector<SurfaceContact>> found;  ///< (chunks of pairs)
};

/// Puts into ws.watch all pairs that may come within their thickness while particles go straight from x to
/// `end`. They are searched for again only where a particle leaves the box that the last search allowed it.
void watch_pairs(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> end,
                 SurfaceContactWorkspace& ws);

/// Forgets the contacts of the last step; and, when those of this one are found, lists them by particle.
void begin_contacts(SurfaceContactWorkspace& ws);
void end_contacts(std::size_t particles, SurfaceContactWorkspace& ws);

/// Adds the contacts of cloth with cloth of a step of h seconds from (x, v): pairs that would be nearer than
/// their thickness at `ahead`, where the step would end without contact between surfaces. In an order that
/// follows from the model and the positions alone. Split by κ ≤ threshold.
void find_contacts(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> v,
                   std::span<const Vec3> ahead, double h, double threshold, SurfaceContactWorkspace& ws);

/// What contacts do to one particle at the start of the step. [N]
inline Vec3 contact_force(const SurfaceContactWorkspace& ws, std::uint32_t particle) {
    Vec3 f = Vec3::Zero();
    for (const std::uint32_t k : ws.at.of(particle)) f += ws.stencils[k / 4].w[k % 4] * ws.force[k / 4];
    return f;
}

}  // namespace unravel::sim
