#include "sim/constraints/friction.hpp"

#include <algorithm>
#include <cmath>

#include "sim/constraints/touch_groups.hpp"

namespace unravel::sim {

namespace {

// A constraint that pulls by more than this share of the particle's weight lets go.
constexpr double pull_share = 1e-3;
// A step is solved again where friction that is off makes a particle slower than this [m/s]. Less is made
// good in the next step.
constexpr double prompt_speed = 1e-2;

// What has slid is held after it has been stopped for so many steps.
constexpr std::uint8_t quiet_steps = 1;

double kinetic_impulse(const Friction& friction, const StepView& view, double force) {
    return view.h_force * friction.kinetic * std::max(force, 0.0);
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

// What the cloth has against a particle's motion along d where all others stay, friction apart: A's own block
// [kg].
double resistance(const Mat3& block, double drag, const Vec3& d) {
    return (block * d).norm() / d.norm() - drag;
}

// v_ε
double least_slip(double kinetic, double resistance) {
    return kinetic > 0 ? std::min(creep_speed, kinetic / resistance) : creep_speed;
}

// What slid at `before` and slides at `now` will slide at after the next step, if it goes on like that;
// within a factor of two, for it may not; v_ε at least.
Vec3 slip_ahead(const Vec3& before, const Vec3& now, double least) {
    const double speed = now.norm();
    if (speed == 0) return now;
    const double ahead = std::clamp(speed + now.dot(now - before) / speed, 0.5 * speed, 2.0 * speed);
    return std::max(ahead, least) / speed * now;
}

// By how much a held particle is held by more than friction bears [N]; 0 where it holds.
double overheld(std::span<const Solid> solids, const StepView& view, std::span<const Touch> group,
                const HoldingForce& holding) {
    if (!is_held(group)) return 0;
    const double excess = holding.across.norm() - bearing_of(solids, group, holding);
    return excess > nothing_at(view, group.front().contact.particle) ? excess : 0;
}

// What a step has shown of a touch that slides.
struct Sliding {
    Vec3 slip{0, 0, 0};     // m/s
    double speed = 0;       // m/s
    double kinetic = 0;     // kg·m/s, Coulomb's impulse
    double resisted = 0;    // kg·m/s, friction's impulse as it was
    double resistance = 0;  // kg
};

Sliding sliding_of(const Friction& friction, const StepView& view, const Touch& touch, const Mat3& block,
                   const Vec3& velocity, double force) {
    Sliding s;
    s.slip = tangential(touch, velocity);
    s.speed = s.slip.norm();
    s.kinetic = kinetic_impulse(friction, view, force);
    s.resisted = touch.rub.norm() + touch.drag_added * s.speed;
    s.resistance =
        s.speed > 0 ? resistance(block, touch.drag_added, s.slip) : view.mass[touch.contact.particle];
    return s;
}

// Whether friction can stop what slides: its own motion, with what drives it, and what its springs would
// answer if it alone stopped.
bool is_stopped(const Friction& friction, const StepView& view, const Touch& touch, const Sliding& sliding,
                double force) {
    const double bears = view.h_force * friction.static_ * std::max(force, 0.0);
    const double own = view.mass[touch.contact.particle] * sliding.speed;
    return bears > 0 && sliding.resisted + own <= bears && sliding.resistance * sliding.speed <= bears;
}

}  // namespace

void try_holds(std::span<const Solid> solids, const StepView& view, std::span<Touch> touches) {
    for (Touch& touch : touches) {
        Contact& c = touch.contact;
        const Friction& friction = solids[c.solid].friction;
        if (touch.pinched) c.held = c.begins = false;  // by both, however hard it is pulled
        if (touch.is_new) c.slip = tangential(touch, view.v[c.particle]);
        const double slip = c.slip.norm();
        const double stopping = view.h_force * friction.static_ * c.force / view.mass[c.particle];
        const bool stays = slip <= creep_speed;
        if (touch.is_new && !touch.pinched && stays && stopping > 0) c.held = true;
        if (touch.pinched || c.held) continue;
        const double kinetic = kinetic_impulse(friction, view, c.force);
        if (c.begins) {
            touch.rub = -kinetic * c.slip;
        } else {
            touch.drag = kinetic / (slip > 0 ? slip : creep_speed);
        }
    }
}

bool any_friction(std::span<const Touch> touches) {
    return std::ranges::any_of(touches, [](const Touch& t) { return t.drag > 0 || !t.rub.isZero(0); });
}

void add_friction(std::span<const Vec3> v, const Constraints& constraints, std::span<Touch> touches,
                  std::span<double> inertia, std::span<Vec3> impulse) {
    for (Touch& touch : touches) {
        const std::uint32_t p = touch.contact.particle;
        const Constraint& constraint = *constraints.find(p);
        const bool slides = constraint.free > 0;
        const double drag = slides ? touch.drag : 0.0;
        Vec3 push = drag * (constraint.z - constraint.S * (constraint.z + v[p] - touch.velocity));
        if (slides) push += constraint.S * touch.rub;
        inertia[p] += drag - touch.drag_added;
        impulse[p] += push - touch.push_added;
        touch.drag_added = drag;
        touch.push_added = push;
    }
}

bool test_holds(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                const Reactions& reactions, std::span<Touch> touches) {
    bool again = false;
    const auto slides = [&](Touch& touch, double force, const Vec3& towards) {
        touch.contact.held = false;
        touch.contact.begins = true;
        touch.contact.force = std::max(force, 0.0);
        touch.drag = 0;
        touch.rub = -kinetic_impulse(solids[touch.contact.solid].friction, view, force) * towards;
        again = true;
    };
    const auto test = [&](Group group, std::size_t k, const HoldingForce& holding) {
        const Mat3& block = reactions.block[k];
        if (is_held(group)) {
            const double excess = overheld(solids, view, group, holding);
            if (!(excess > 0)) return;
            const double lost = view.h_force * excess / resistance(block, 0, holding.across);
            if (!(lost > prompt_speed)) return;
            for (std::size_t t = 0; t < group.size(); ++t)
                slides(group[t], holding.along[t], -holding.across.normalized());
            return;
        }
        if (constraints.all()[k].free == 0) return;  // by solids alone
        for (std::size_t t = 0; t < group.size(); ++t) {
            Touch& touch = group[t];
            const Sliding now = sliding_of(solids[touch.contact.solid].friction, view, touch, block,
                                           reactions.velocity[k], holding.along[t]);
            if (touch.drag_added > 0 && (now.resisted - now.kinetic) / now.resistance > prompt_speed)
                slides(touch, holding.along[t], now.slip / now.speed);
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
        const bool holds = overheld(solids, view, group, holding) == 0;
        for (std::size_t t = 0; t < group.size(); ++t) {
            const Touch& touch = group[t];
            Contact c = touch.contact;
            if (touch.pinched) {
                out.push_back({c.particle, c.solid, false, false, quiet_steps, std::abs(holding.along[t])});
                continue;
            }
            if (holding.along[t] < -nothing) {
                out.push_back({c.particle, c.solid, false, false, 0, holding.along[t]});
                continue;
            }
            c.force = std::max(holding.along[t], 0.0);
            c.begins = c.held && !holds;
            if (c.begins) {
                c.held = false;
                c.sliding = quiet_steps;
                c.slip = -holding.across.normalized();
            } else if (c.held) {
                c.sliding = 0;
                c.slip.setZero();
            } else {
                const Friction& friction = solids[c.solid].friction;
                const Sliding now =
                    sliding_of(friction, view, touch, reactions.block[k], reactions.velocity[k], c.force);
                if (!is_stopped(friction, view, touch, now, c.force)) {
                    c.sliding = quiet_steps;
                } else if (c.sliding > 0) {
                    --c.sliding;
                }
                c.held = c.sliding == 0;
                const Vec3 ahead = slip_ahead(tangential(touch, view.v[c.particle]), now.slip,
                                              least_slip(now.kinetic, now.resistance));
                c.slip = c.held ? Vec3(0, 0, 0) : ahead;
            }
            out.push_back(c);
        }
    };
    for_each_holding(view, constraints, reactions, touches, judge);
}

}  // namespace unravel::sim
