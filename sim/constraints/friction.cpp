#include "sim/constraints/friction.hpp"

#include <algorithm>
#include <cmath>

#include "sim/constraints/touch_groups.hpp"

namespace unravel::sim {

namespace {

// A constraint that pulls by more than this share of the particle's weight lets go.
constexpr double pull_share = 1e-3;
// Far from held, or foreseen far off: by so many times what friction bears, and by more than the particle's
// weight. Less is made good in the next step.
constexpr double far_off = 2;
// After a trial that failed so many steps go by before the next.
constexpr std::uint8_t steps_between_trials = 1;
// A new contact is tried as held where friction would stop it within this share of the step.
constexpr double stopping_share = 0.5;

double drag_of(const Friction& friction, const StepView& view, double force, double slip) {
    return view.h_force * friction.kinetic * std::max(force, 0.0) / std::max(slip, creep_speed);
}

// What is no force at this particle [N].
double nothing_at(const StepView& view, std::uint32_t p) {
    return pull_share * view.mass[p] * view.gravity.norm();
}

// What holds a particle, over its touches: force along each one's normal, and what is left across them all.
struct HoldingForce {
    std::vector<double> along;  // (touches of the particle) N
    Vec3 across{0, 0, 0};       // N
};

void split_force(std::span<const Touch> group, const Vec3& force, HoldingForce& out) {
    out.along.resize(group.size());
    if (group.size() == 1) {
        const Vec3& n = group.front().normal;
        out.along[0] = n.dot(force);
        out.across = force - out.along[0] * n;
        return;
    }
    const auto N = taken_directions(group);
    const Eigen::VectorXd share =
        (N.transpose() * N).eval().ldlt().solve(Eigen::VectorXd(N.transpose() * force));
    out.across = force - N * share;
    for (std::size_t t = 0; t < group.size(); ++t) {
        for (Eigen::Index k = 0; k < N.cols(); ++k) {
            if (same_direction(N.col(k), group[t].normal)) out.along[t] = share[k];
        }
    }
}

// Calls f(group, constraint's index, what holds it) for each particle that touches.
template <typename T, typename F>
void for_each_holding(const StepView& view, const Constraints& constraints, const Reactions& reactions,
                      std::span<T> touches, const F& f) {
    HoldingForce holding;
    for_each_group(touches, [&](std::span<T> group) {
        const Constraint* constraint = constraints.find(group.front().contact.particle);
        const auto k = static_cast<std::size_t>(constraint - constraints.all().data());
        split_force(group, reactions.impulse[k] / view.h_force, holding);
        f(group, k, holding);
    });
}

bool is_held(std::span<const Touch> group) {
    return std::ranges::any_of(group, [](const Touch& t) { return t.contact.held; });
}

// What friction bears across all of a particle's normals [N].
double bearing_of(std::span<const Solid> solids, std::span<const Touch> group, const HoldingForce& holding) {
    double bears = 0;
    for (std::size_t t = 0; t < group.size(); ++t)
        bears += solids[group[t].contact.solid].friction.static_ * std::max(holding.along[t], 0.0);
    return bears;
}

// Whether friction can stop what slides at velocity `slip` at the step's end under normal force N.
bool is_stopped(const Friction& friction, const StepView& view, const Touch& touch, const Mat3& block,
                const Vec3& slip, double force) {
    const double bears = view.h_force * friction.static_ * force;
    if (!(bears > 0)) return false;
    const double speed = slip.norm();
    const double alone = (touch.drag_added + view.mass[touch.contact.particle]) * speed;
    return alone <= bears && (speed <= creep_speed || (block * slip).norm() <= bears);
}

}  // namespace

void try_holds(std::span<const Solid> solids, const StepView& view, std::span<Touch> touches) {
    for (Touch& touch : touches) {
        Contact& c = touch.contact;
        const Friction& friction = solids[c.solid].friction;
        const double slip = tangential(touch, view.v[c.particle]).norm();
        const double stopping = friction.static_ * c.force * view.h_force / view.mass[c.particle];
        if (touch.is_new && stopping_share * stopping >= slip && stopping > 0) c.held = true;
        touch.drag = c.held || touch.pinched ? 0.0 : drag_of(friction, view, c.force, slip);
    }
}

bool any_friction(std::span<const Touch> touches) {
    return std::ranges::any_of(touches, [](const Touch& t) { return t.drag > 0; });
}

void add_friction(std::span<const Vec3> v, const Constraints& constraints, std::span<Touch> touches,
                  std::span<double> inertia, std::span<Vec3> impulse) {
    for (Touch& touch : touches) {
        const std::uint32_t p = touch.contact.particle;
        const Constraint& constraint = *constraints.find(p);
        const double drag = constraint.free == 0 ? 0.0 : touch.drag;
        const Vec3 push = drag * (constraint.z - constraint.S * constraint.z - tangential(touch, v[p]));
        inertia[p] += drag - touch.drag_added;
        impulse[p] += push - touch.push_added;
        touch.drag_added = drag;
        touch.push_added = push;
    }
}

bool test_holds(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                const Reactions& reactions, std::span<Touch> touches) {
    bool again = false;
    const auto test = [&](Group group, std::size_t k, const HoldingForce& holding) {
        const bool held = is_held(group);
        if (!held && constraints.all()[k].free == 0) return;  // by solids alone
        const double weight = view.mass[group.front().contact.particle] * view.gravity.norm();
        const bool fails =
            held && holding.across.norm() > far_off * bearing_of(solids, group, holding) + weight;
        if (held && !fails) return;
        for (std::size_t t = 0; t < group.size(); ++t) {
            Touch& touch = group[t];
            const Friction& friction = solids[touch.contact.solid].friction;
            const double force = std::max(holding.along[t], 0.0);
            const double slip = tangential(touch, reactions.velocity[k]).norm();
            const double most = view.h_force * (far_off * friction.kinetic * force + weight);
            // What has been sliding has its speed and force from the step before.
            const bool begins = touch.is_new || touch.contact.slip.isZero(0);
            if (!fails && !(begins && touch.drag_added * slip > most)) continue;
            again = true;
            touch.contact.held = false;
            if (fails) touch.contact.sliding = steps_between_trials;
            touch.contact.slip.setZero();
            touch.contact.force = force;
            touch.drag = drag_of(friction, view, force, slip);
        }
    };
    for_each_holding(view, constraints, reactions, touches, test);
    return again;
}

void judge_touches(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                   const Reactions& reactions, std::span<const Touch> touches, std::vector<Contact>& out) {
    out.clear();
    const auto judge = [&](std::span<const Touch> group, std::size_t k, const HoldingForce& holding) {
        const double nothing = nothing_at(view, group.front().contact.particle);
        const bool holds = holding.across.norm() <= bearing_of(solids, group, holding) + nothing;
        for (std::size_t t = 0; t < group.size(); ++t) {
            const Touch& touch = group[t];
            Contact c = touch.contact;
            if (touch.pinched) {
                c.force = std::abs(holding.along[t]);
                c.held = false;
                out.push_back(c);
                continue;
            }
            if (holding.along[t] < -nothing) {
                out.push_back({c.particle, c.solid, false, 0, holding.along[t], Vec3::Zero()});
                continue;
            }
            c.force = std::max(holding.along[t], 0.0);
            if (c.held) {
                c.held = holds;
                c.sliding = holds ? 0 : steps_between_trials;
            } else {
                c.slip = tangential(touch, reactions.velocity[k]);
                if (c.sliding > 0) {
                    --c.sliding;
                } else {
                    c.held = is_stopped(solids[c.solid].friction, view, touch, reactions.block[k], c.slip,
                                        c.force);
                }
                if (c.held) c.slip.setZero();
            }
            out.push_back(c);
        }
    };
    for_each_holding(view, constraints, reactions, touches, judge);
}

}  // namespace unravel::sim
