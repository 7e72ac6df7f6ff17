#include "sim/constraints/friction.hpp"

#include <algorithm>
#include <cmath>

#include "sim/constraints/touch_groups.hpp"

namespace unravel::sim {

namespace {
double env(const char* n, double d) { const char* e = getenv(n); return e ? atof(e) : d; }
const double F_wait = env("F_wait", 3), F_rule = env("F_rule", 0), F_share = env("F_share", 1), F_mild = env("F_mild", 1), F_over=env("F_over",1), F_dbg=env("F_dbg",0);

// A constraint that pulls by more than this share of the particle's weight lets go.
constexpr double pull_share = 1e-3;
// After a trial that failed so many steps go by before the next: what is far from holding is not solved twice
// in each.
constexpr std::uint8_t steps_between_trials = 3;
// Friction that is so many times what the solve's normal force bears was foreseen wrong.
constexpr double foreseen_wrong = 2;

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
template <typename F>
void for_each_holding(const StepView& view, const Constraints& constraints, std::span<const Vec3> reaction,
                      std::span<Touch> touches, const F& f) {
    HoldingForce holding;
    for_each_group(touches, [&](Group group) {
        const Constraint* constraint = constraints.find(group.front().contact.particle);
        const auto k = static_cast<std::size_t>(constraint - constraints.all().data());
        split_force(group, reaction[k] / view.h_force, holding);
        f(group, k, holding);
    });
}

bool is_held(std::span<const Touch> group) {
    return std::any_of(group.begin(), group.end(), [](const Touch& t) { return t.contact.held; });
}

}  // namespace

void try_holds(std::span<const Solid> solids, const StepView& view, std::span<Touch> touches) {
    for (Touch& touch : touches) {
        Contact& c = touch.contact;
        const Friction& friction = solids[c.solid].friction;
        const double slip = tangential(touch, view.v[c.particle]).norm();
        const double stopping = friction.static_ * c.force * view.h_force / view.mass[c.particle];
        if (touch.is_new && stopping >= slip && stopping > 0) c.held = true;
        touch.drag = c.held || touch.pinched ? 0.0 : drag_of(friction, view, c.force, slip);
    }
}

bool any_friction(std::span<const Touch> touches) {
    return std::any_of(touches.begin(), touches.end(), [](const Touch& t) { return t.drag > 0; });
}

void add_friction(std::span<const Vec3> v, const Constraints& constraints, std::span<Touch> touches,
                  std::span<double> inertia, std::span<Vec3> impulse) {
    for (Touch& touch : touches) {
        const std::uint32_t p = touch.contact.particle;
        const Constraint& constraint = *constraints.find(p);
        const double drag = constraint.free == 0 ? 0.0 : touch.drag;
        const Vec3 push =
            drag * (constraint.z - constraint.S * constraint.z - tangential(touch, v[p]));
        inertia[p] += drag - touch.drag_added;
        impulse[p] += push - touch.push_added;
        touch.drag_added = drag;
        touch.push_added = push;
    }
}

bool test_holds(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                std::span<const Vec3> reaction, std::span<const Vec3> v_end, std::span<Touch> touches) {
    bool again = false;
    for_each_holding(view, constraints, reaction, touches, [&](Group group, std::size_t k,
                                                                const HoldingForce& holding) {
        const std::uint32_t p = group.front().contact.particle;
        const double nothing = nothing_at(view, p);
        const bool held = is_held(group);
        if (!held && constraints.all()[k].free == 0) return;  // by solids alone
        double bears = nothing;
        for (std::size_t t = 0; t < group.size(); ++t)
            bears += solids[group[t].contact.solid].friction.static_ * std::max(holding.along[t], 0.0);
        const bool fails = held && holding.across.norm() > F_mild * bears;
        if (F_dbg && fails) fprintf(stderr, "fail p %u across %g bears %g N %g new %d\n", p, holding.across.norm(), bears, holding.along[0], int(group[0].is_new));
        if (held && !fails) {
            if (holding.across.norm() > bears) for (Touch& t : group) t.mild = true;
            return;
        }
        for (std::size_t t = 0; t < group.size(); ++t) {
            Touch& touch = group[t];
            const Friction& friction = solids[touch.contact.solid].friction;
            const double force = std::max(holding.along[t], 0.0);
            const double slip = tangential(touch, v_end[k]).norm();
            const double wrong = foreseen_wrong * view.h_force * (friction.kinetic * force + nothing);
            // A slider of some time has its speed and force from the step before.
            const bool begins = F_over > 0 && (touch.failed || touch.is_new || touch.contact.slip.isZero(0));
            if (!fails && !(begins && touch.drag * slip > wrong)) continue;
            again = true;
            touch.failed = touch.failed || fails;
            touch.contact.held = false;
            touch.contact.force = force;
            touch.drag = drag_of(friction, view, force, slip);
        }
    });
    return again;
}

void judge_touches(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                   std::span<const Vec3> reaction, std::span<const Vec3> v_end, std::span<Touch> touches,
                   std::vector<Contact>& out) {
    out.clear();
    for_each_holding(view, constraints, reaction, touches, [&](Group group, std::size_t k,
                                                                const HoldingForce& holding) {
        const std::uint32_t p = group.front().contact.particle;
        const double nothing = nothing_at(view, p);
        for (std::size_t t = 0; t < group.size(); ++t) {
            const Touch& touch = group[t];
            const Friction& friction = solids[touch.contact.solid].friction;
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
            if (touch.mild && c.held) { c.held = false; c.sliding = F_wait; }
            else if (!c.held) {
                c.slip = tangential(touch, v_end[k]);
                c.sliding = touch.failed ? F_wait : c.sliding > 0 ? c.sliding - 1 : 0;
                // What it takes to stop it altogether: what friction has done, and what it has left.
                const double needed = (touch.drag + view.mass[p]) * c.slip.norm();
                c.held = c.sliding == 0 && c.force > 0 && friction.static_ > 0 &&
                         (F_rule == 0 ? needed <= F_share * view.h_force * friction.static_ * c.force : c.slip.norm() < F_share * creep_speed);
            }
            if (c.held) c.slip.setZero();
            out.push_back(c);
        }
    });
}

}  // namespace unravel::sim
