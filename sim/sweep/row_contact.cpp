#include "sim/sweep/row_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/constraints/friction.hpp"
#include "sim/solids/sdf.hpp"

namespace unravel::sim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Beyond this turn in one substep nothing is foreseen [radians].
constexpr double largest_turn = 0.1;

Vec3 at(const Row& row, std::size_t k) {
    return {row[0][k], row[1][k], row[2][k]};
}
void put(const Row& row, std::size_t k, const Vec3& y) {
    for (std::size_t c = 0; c < 3; ++c) row[c][k] = y[static_cast<Eigen::Index>(c)];
}

double fastest(const RowStretch& stretch) {
    return std::sqrt(largest_squared_speed({stretch.v[0], stretch.v[1], stretch.v[2]}, stretch.count));
}

double measure_clearance(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch) {
    double least = infinity;
    for (std::size_t s = 0; s < model.solids.size(); ++s) {
        const Pose local = substep.poses.now[s].inverse(Eigen::Isometry);
        for (std::size_t k = 0; k < stretch.count; ++k) {
            least = std::min(
                least, signed_distance(model.solids[s], local * at(stretch.x, k)) - model.solids[s].offset);
        }
    }
    return least;
}

// What is pinned touches nothing; it comes first among the constraints.
void hold_pinned(const RowStretch& stretch, RowContactScratch& scratch) {
    scratch.constraints.reset(stretch.count);
    for (const std::uint32_t k : stretch.pinned) scratch.constraints.add({k, 0, Mat3::Zero(), Vec3::Zero()});
}

StepView view_of(const ClothModel& model, double h, const RowContactScratch& scratch) {
    return {scratch.x, scratch.v, scratch.mass, h, model.gravity, h, h};
}

// Constrains what touches, and finds what that does to it: nothing is coupled.
void solve_touches(const ClothModel& model, const RowStretch& stretch, const StepView& view,
                   RowContactScratch& scratch) {
    constrain_touches(model.solids, view, scratch.touches, scratch.x, scratch.constraints);
    add_friction(scratch.v, scratch.constraints, scratch.touches, scratch.inertia, scratch.impulse);
    const std::span<const Constraint> all = scratch.constraints.all();
    scratch.dv.resize(all.size());
    scratch.reactions.resize(all.size());
    for (std::size_t c = stretch.pinned.size(); c < all.size(); ++c) {
        const std::uint32_t k = all[c].particle;
        const Vec3 free = scratch.impulse[k] / scratch.inertia[k];
        scratch.dv[c] = all[c].S * free + (all[c].z - all[c].S * all[c].z);
        scratch.reactions.velocity[c] = scratch.v[k] + scratch.dv[c];
        scratch.reactions.impulse[c] = scratch.inertia[k] * scratch.dv[c] - scratch.impulse[k];
        scratch.reactions.block[c] = scratch.inertia[k] * Mat3::Identity();
    }
}

}  // namespace

void pose_substep(std::span<const Solid> solids, double t, double h, SolidSubstep& out) {
    pose_solids(solids, t, h, out.poses);
    out.travel = 0;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        if (!solids[s].moves()) continue;
        const SolidReach& reach = out.poses.reach[s];
        const bool foreseen = reach.turn <= largest_turn && (reach.turn == 0 || std::isfinite(reach.radius));
        out.travel =
            !foreseen ? infinity
                      : std::max(out.travel,
                                 reach.travel +
                                     (reach.turn > 0 ? reach.turn * (reach.radius + solids[s].offset) : 0.0));
    }
}

bool may_touch(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch, double h,
               RowContacts& contacts) {
    if (!contacts.contacts.empty() || substep.travel == infinity) return true;
    // A solid's material may come nearer to a particle beside it than its own surface does: by the turn times
    // the clearance itself, for which 1 − largest_turn stands.
    const double needed =
        (h * (fastest(stretch) + h * model.gravity.norm()) + substep.travel) / (1.0 - largest_turn);
    if (contacts.clearance > needed) return false;
    contacts.clearance = measure_clearance(model, substep, stretch);
    return !(contacts.clearance > needed);
}

bool keeps_clear(const SolidSubstep& substep, const RowStretch& stretch, double h, RowContacts& contacts) {
    contacts.clearance -= h * fastest(stretch) + substep.travel;
    return contacts.clearance > 0;
}

void meet_solids(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch, double h,
                 RowContacts& contacts, RowContactScratch& scratch) {
    const std::size_t n = stretch.count;
    scratch.x.resize(n);
    scratch.v.resize(n);
    scratch.impulse.resize(n);
    scratch.mass.assign(stretch.mass, stretch.mass + n);
    for (std::size_t k = 0; k < n; ++k) {
        scratch.x[k] = at(stretch.x, k);
        scratch.v[k] = at(stretch.v, k);
        scratch.impulse[k] = h * (stretch.mass[k] * model.gravity + at(stretch.f, k));
    }
    scratch.base = scratch.x;
    scratch.inertia = scratch.mass;
    hold_pinned(stretch, scratch);
    const StepView view = view_of(model, h, scratch);
    find_touches(model.solids, substep.poses, view, contacts.contacts, scratch.constraints, scratch.found,
                 scratch.touches);
    settle_touches(model.solids, view, scratch.touches, scratch.base);
    try_holds(model.solids, view, scratch.touches);
    solve_touches(model, stretch, view, scratch);
    for (std::uint32_t trial = 0; trial < most_trials; ++trial) {
        if (!test_holds(model.solids, view, scratch.constraints, scratch.reactions, scratch.touches)) break;
        hold_pinned(stretch, scratch);
        solve_touches(model, stretch, view, scratch);
    }
    judge_touches(model.solids, view, scratch.constraints, scratch.reactions, scratch.touches,
                  contacts.contacts);
    const std::span<const Constraint> all = scratch.constraints.all();
    contacts.touches = static_cast<std::uint32_t>(scratch.touches.size());
    contacts.constraints.assign(all.begin() + static_cast<std::ptrdiff_t>(stretch.pinned.size()), all.end());
}

void settle_contacts(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch,
                     double h, bool met, RowContactScratch& scratch) {
    if (!met) {
        scratch.x.resize(stretch.count);
        scratch.v.resize(stretch.count);
        hold_pinned(stretch, scratch);
    }
    const std::span<const Constraint> all = scratch.constraints.all();
    for (std::size_t c = stretch.pinned.size(); c < all.size(); ++c) {
        const std::uint32_t k = all[c].particle;
        const Vec3 v = scratch.v[k] + scratch.dv[c];
        put(stretch.v, k, v);
        put(stretch.x, k, scratch.base[k] + h * v);
    }
    for (std::size_t k = 0; k < stretch.count; ++k) {
        scratch.x[k] = at(stretch.x, k);
        scratch.v[k] = at(stretch.v, k);
    }
    keep_outside(model.solids, substep.poses, scratch.constraints, h, scratch.x, scratch.v);
    for (std::size_t k = 0; k < stretch.count; ++k) {
        put(stretch.x, k, scratch.x[k]);
        put(stretch.v, k, scratch.v[k]);
    }
}

}  // namespace unravel::sim
