#include "sim/constraints/contact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/constraints/near_solids.hpp"

namespace unravel::sim {

namespace {

// A particle is caught when it would end this share of the offset inside: without it, a particle released at
// rounding distance is caught again at once.
constexpr double catch_share = 0.01;
// Depth is corrected at most this fast [m/s].
constexpr double correction_speed = 0.5;
// A constraint that pulls by more than this share of the particle's weight lets go.
constexpr double pull_share = 1e-3;
// After a slip friction slides for this many steps before it may hold again; without it a slip welds at once.
constexpr std::uint8_t slip_steps = 3;
// Two contacts pinch where their normals' cosine is below this.
constexpr double pinch_cosine = -0.5;
// A gap below this is rounding [m]: what rests then rests to the last bit, and asks for nothing.
constexpr double no_gap = 1e-12;
// What let go with a pull of this many times its weight is not caught again by its weight.
constexpr double strong_pull = 10;
// Contacts this parallel are one direction.
constexpr double parallel_cosine = 0.999;

// How far from a mesh nothing can touch it within the step: the particle, the body and the body's own skin
// don't meet.
double out_of_reach(const Solid& solid, const DeformedSolid* deformed, const Vec3& ridden,
                    const StepView& view, std::uint32_t p) {
    const double own = view.step * (view.v[p] + view.step * view.gravity).norm();
    return 2 * solid.offset + own + (ridden - view.x[p]).norm() + (deformed ? deformed->moved : 0.0);
}

bool touches_solid(const Solid& solid, const DeformedSolid* deformed, const Pose& now, const Pose& next,
                   const StepView& view, std::uint32_t p, const Contact* known, Touch& touch) {
    const Vec3 local = now.inverse(Eigen::Isometry) * view.x[p];
    double cutoff = std::numeric_limits<double>::infinity();
    if (solid.shape == Shape::mesh) cutoff = out_of_reach(solid, deformed, next * local, view, p);
    const SurfacePoint surface = nearest_surface(solid, deformed, false, local, cutoff);
    if (surface.distance > cutoff) return false;
    touch.gap = surface.distance - solid.offset;
    if (std::abs(touch.gap) < no_gap) touch.gap = 0;
    touch.normal = now.linear() * surface.normal;
    touch.velocity.setZero();
    if (solid.moves() || deformed) touch.velocity = (next * surface.carried - view.x[p]) / view.step;
    touch.pinched = false;
    // Gravity is foreseen, so that what is laid on a slope is caught before it has begun to slide. Not of
    // what has just let go: the forces on it, gravity among them, pull it off, and catching it again before
    // it has moved would weld cloth that is pulled over an edge to it.
    const bool let_go = known && known->force < 0;
    const bool pulled_off = let_go && -known->force > strong_pull * view.mass[p] * view.gravity.norm();
    // What pulled it off goes on to: of a solid that brakes as it leaves, speeds alone would have it caught
    // for as long as it brakes.
    const double push = known ? view.step * known->force / view.mass[p] : 0.0;
    const Vec3 fall = pulled_off ? Vec3(-push * touch.normal) : Vec3(view.step * view.gravity);
    const Vec3 coming = view.v[p] + fall - touch.velocity;
    const double ahead = touch.gap + view.step * touch.normal.dot(coming);
    const bool catches = ahead < -catch_share * solid.offset;
    if (known && !let_go) {
        touch.contact = *known;
        // One that has opened but is about to be run over again is still a contact; one that would open
        // though it is pressed as it was is none: it goes round an edge, or is thrown off.
        const double pressed = touch.gap + view.step * (touch.normal.dot(view.v[p] - touch.velocity) - push);
        return catches || (touch.gap < open_share * solid.offset && pressed < catch_share * solid.offset);
    }
    // No force has been felt yet; friction reckons with what it takes to stop the particle at the surface.
    touch.contact.force = view.mass[p] * std::max(-ahead, 0.0) / (view.step * view.step);
    return catches;
}

// Touches of one particle.
using Group = std::span<Touch>;

template <typename F>
void for_each_group(std::span<Touch> touches, const F& f) {
    for (std::size_t first = 0; first < touches.size();) {
        std::size_t last = first + 1;
        while (last < touches.size() && touches[last].contact.particle == touches[first].contact.particle)
            ++last;
        f(touches.subspan(first, last - first));
        first = last;
    }
}

Vec3 tangential(const Touch& touch, const Vec3& v) {
    const Vec3 relative = v - touch.velocity;
    return relative - touch.normal.dot(relative) * touch.normal;
}

// Static friction holds a sliding contact again when friction would stop it within half a step, or has turned
// it round.
void decide_friction(const Friction& friction, const StepView& view, Touch& touch) {
    Contact& c = touch.contact;
    if (c.held) return;
    const Vec3 slip = tangential(touch, view.v[c.particle]);
    const double stopping = friction.kinetic * c.force * view.h_force / view.mass[c.particle];
    const bool may_hold = c.sliding == 0 && c.force > 0 && friction.static_ > 0;
    if (may_hold && (stopping >= 2 * slip.norm() || slip.dot(c.slip) < 0)) {
        c.held = true;
        c.slip.setZero();
    } else {
        c.slip = slip;
        if (c.sliding > 0) --c.sliding;
    }
}

// Whether two solids pinch a particle: they leave it less room than it takes.
bool opposed(const Touch& a, const Touch& b) {
    return a.normal.dot(b.normal) < pinch_cosine && a.gap + b.gap < 0;
}

// Between two solids that leave it room a particle touches the nearer one.
void drop_loose(std::vector<Touch>& touches) {
    std::vector<Touch> kept;
    kept.reserve(touches.size());
    for_each_group(touches, [&](Group group) {
        for (const Touch& touch : group) {
            const bool loose = std::ranges::any_of(group, [&](const Touch& other) {
                const bool faces = touch.normal.dot(other.normal) < pinch_cosine && !opposed(touch, other);
                return faces && (other.gap < touch.gap || (other.gap == touch.gap && &other < &touch));
            });
            if (!loose) kept.push_back(touch);
        }
    });
    touches = std::move(kept);
}

// What the particle must do along one touch's normal, and how deep it sits.
Vec3 closing(const Touch& touch, double h) {
    return -std::max(touch.gap, 0.0) / h * touch.normal;
}

Vec3 depth_correction(const Touch& touch, double h) {
    return std::min(std::max(-touch.gap, 0.0), correction_speed * h) * touch.normal;
}

bool same_direction(const Vec3& a, const Vec3& b) {
    return a == b || a.dot(b) > parallel_cosine;
}

// Directions that a group takes away, as columns; parallel ones count once, and so do those of a pinch.
Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> taken_directions(Group group) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> N(3, 0);
    for (const Touch& touch : group) {
        if (N.cols() == 3) break;
        bool known = false;
        for (Eigen::Index k = 0; k < N.cols(); ++k)
            known = known || same_direction(N.col(k), touch.normal) ||
                    (touch.pinched && same_direction(N.col(k), -touch.normal));
        if (known) continue;
        N.conservativeResize(3, N.cols() + 1);
        N.col(N.cols() - 1) = touch.normal;
    }
    return N;
}

// The vector of span(N) with given components along N's columns.
template <typename Matrix>
Vec3 with_components(const Matrix& N, const Eigen::VectorXd& c) {
    return N * (N.transpose() * N).eval().ldlt().solve(c);
}

void add_kinetic_friction(const Friction& friction, const StepView& view, const Contact& c, Vec3& impulse) {
    const double slip = c.slip.norm();
    if (slip == 0 || c.force <= 0) return;
    const double most = view.mass[c.particle] * slip;  // friction stops, it never turns round
    impulse -= std::min(most, friction.kinetic * c.force * view.h_force) / slip * c.slip;
}

// Velocity that a solid's own gives to v' so that x' follows the solid over the step; 1 for one-step schemes.
double carry(const StepView& view) {
    return view.step / view.h;
}

// Nearly every touching particle touches once: one normal, no linear algebra.
void constrain_single(const Friction& friction, const StepView& view, Touch& touch, Constraints& constraints,
                      std::span<Vec3> base, std::span<Vec3> impulse) {
    const std::uint32_t p = touch.contact.particle;
    const Vec3& n = touch.normal;
    decide_friction(friction, view, touch);
    Constraint c;
    c.particle = p;
    c.z = (view.x[p] - base[p]) / view.h + carry(view) * touch.velocity + closing(touch, view.h) - view.v[p];
    base[p] += depth_correction(touch, view.h);
    if (!touch.contact.held) {
        c.free = 2;
        c.S = Mat3::Identity() - n * n.transpose();
        c.z = n.dot(c.z) * n;
        add_kinetic_friction(friction, view, touch.contact, impulse[p]);
    }
    constraints.add(c);
}

// Along a direction of a pinch: the speed of the solids, and the way to the middle between them.
void pinch_along(const StepView& view, Group group, const Vec3& n, const Vec3& from_base, double& speed,
                 double& depth) {
    double ride = 0, way = 0;
    int sides = 0;
    for (const Touch& touch : group) {
        if (!same_direction(n, touch.normal) && !same_direction(n, -touch.normal)) continue;
        ride += n.dot(from_base + carry(view) * touch.velocity);
        way -= touch.gap * n.dot(touch.normal);
        ++sides;
    }
    const double limit = correction_speed * view.h;
    speed = ride / sides;
    depth = std::clamp(way / sides, -limit, limit);
}

void constrain_group(std::span<const Solid> solids, const StepView& view, Group group,
                     Constraints& constraints, std::span<Vec3> base, std::span<Vec3> impulse) {
    const std::uint32_t p = group.front().contact.particle;
    bool held = false, rough = false;
    for (Touch& touch : group) {
        decide_friction(solids[touch.contact.solid].friction, view, touch);
        held = held || touch.contact.held;
        for (const Touch& other : group) {
            touch.pinched = touch.pinched || opposed(touch, other);
            rough = rough || (touch.pinched && solids[other.contact.solid].friction.static_ > 0);
        }
    }
    const bool pinched = std::any_of(group.begin(), group.end(), [](const Touch& t) { return t.pinched; });
    auto N = taken_directions(group);
    const bool all = held || (pinched && rough) || (N.cols() == 3 && std::abs(Mat3(N).determinant()) > 1e-6);

    Constraint c;
    c.particle = p;
    const Vec3 from_base = (view.x[p] - base[p]) / view.h;
    if (all) {
        // Rides on what holds it: the held contacts' solids, or all of them in a pinch. Depths of opposing
        // normals average to the middle of the gap.
        Vec3 ride = Vec3::Zero(), close = Vec3::Zero(), depth = Vec3::Zero();
        int riders = 0;
        for (const Touch& touch : group) {
            close += closing(touch, view.h);
            depth += pinched ? (-touch.gap * touch.normal).eval() : depth_correction(touch, view.h);
            if (!touch.contact.held && held) continue;
            ride += touch.velocity;
            ++riders;
        }
        if (pinched) {
            depth /= static_cast<double>(group.size());
            const double limit = correction_speed * view.h;
            if (depth.norm() > limit) depth *= limit / depth.norm();
            close.setZero();
        }
        c.free = 0;
        c.z = from_base + carry(view) / riders * ride + close - view.v[p];
        base[p] += depth;
    } else {
        if (N.cols() == 3) N.conservativeResize(3, 2);
        Eigen::VectorXd speed(N.cols()), depth(N.cols());
        speed.setConstant(-std::numeric_limits<double>::infinity());
        depth.setZero();
        for (const Touch& touch : group) {
            for (Eigen::Index k = 0; k < N.cols(); ++k) {
                if (!same_direction(N.col(k), touch.normal)) continue;
                // Smooth solids hold what they pinch in the middle between them, and let it slide there.
                if (touch.pinched) {
                    pinch_along(view, group, N.col(k), from_base, speed[k], depth[k]);
                    continue;
                }
                speed[k] = std::max(speed[k], touch.normal.dot(from_base + carry(view) * touch.velocity +
                                                               closing(touch, view.h)));
                depth[k] = std::max(depth[k], depth_correction(touch, view.h).norm());
            }
        }
        c.free = static_cast<std::uint8_t>(3 - N.cols());
        c.S = Mat3::Identity() - N * (N.transpose() * N).eval().ldlt().solve(Eigen::MatrixXd(N.transpose()));
        c.S = 0.5 * (c.S + c.S.transpose()).eval();
        c.z = with_components(N, speed - N.transpose() * view.v[p]);
        base[p] += with_components(N, depth);
        for (const Touch& touch : group) {
            add_kinetic_friction(solids[touch.contact.solid].friction, view, touch.contact, impulse[p]);
        }
    }
    constraints.add(c);
}

// Force along each touch's normal: `force` split over the group's normals.
void split_force(Group group, const Vec3& force, std::span<double> along) {
    if (group.size() == 1) {
        along[0] = group.front().normal.dot(force);
        return;
    }
    const auto N = taken_directions(group);
    const Eigen::VectorXd share =
        (N.transpose() * N).eval().ldlt().solve(Eigen::VectorXd(N.transpose() * force));
    for (std::size_t t = 0; t < group.size(); ++t) {
        along[t] = 0;
        for (Eigen::Index k = 0; k < N.cols(); ++k) {
            if (same_direction(N.col(k), group[t].normal)) along[t] = share[k];
        }
    }
}

// Contact after the solve, from the force that held it.
Contact judge(const Friction& friction, const Touch& touch, const Vec3& force, double normal,
              double nothing) {
    Contact c = touch.contact;
    if (touch.pinched) {
        c.force = std::abs(normal);
        c.held = false;
        return c;
    }
    if (normal < -nothing) {
        c = {c.particle, c.solid, false, 0, normal, Vec3::Zero()};
        return c;
    }
    c.force = std::max(normal, 0.0);
    const Vec3 across = force - touch.normal.dot(force) * touch.normal;
    if (c.held && across.norm() > friction.static_ * c.force + nothing) {
        c.held = false;
        c.sliding = slip_steps;
        c.slip.setZero();
    }
    return c;
}

}  // namespace

void find_touches(std::span<const Solid> solids, const SolidPoses& poses, const StepView& view,
                  std::span<const Contact> known, const Constraints& pinned,
                  std::vector<std::vector<Touch>>& found, std::vector<Touch>& out) {
    out.clear();
    found.resize(chunk_count(view.x.size()));
    const double fall = view.step * view.gravity.norm();
    parallel_chunks(view.x.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        found[chunk].clear();
        const auto near =
            NearSolids::to_touch(poses.reach, view.x.subspan(begin, end - begin),
                                 view.v.subspan(begin, end - begin), view.step, fall / view.step);
        if (near.none()) return;
        auto next = std::lower_bound(known.begin(), known.end(), begin,
                                     [](const Contact& c, std::size_t p) { return c.particle < p; });
        for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
            while (next != known.end() && next->particle < p) ++next;
            if (pinned.find(p)) continue;
            const double ahead = view.step * (view.v[p].norm() + fall);
            for (std::uint32_t s = 0; s < solids.size(); ++s) {
                if (!near.has(s) || poses.reach[s].is_far(view.x[p], ahead)) continue;
                const Contact* before = nullptr;
                for (auto k = next; k != known.end() && k->particle == p; ++k) {
                    if (k->solid == s) before = &*k;
                }
                Touch touch;
                touch.contact.particle = p;
                touch.contact.solid = s;
                if (touches_solid(solids[s], poses.of(solids[s], s), poses.now[s], poses.next[s], view, p,
                                  before, touch)) {
                    found[chunk].push_back(touch);
                }
            }
        }
    });
    for (const std::vector<Touch>& part : found) out.insert(out.end(), part.begin(), part.end());
}

void constrain_touches(std::span<const Solid> solids, const StepView& view, std::vector<Touch>& touches,
                       Constraints& constraints, std::span<Vec3> base, std::span<Vec3> impulse) {
    const bool several = std::ranges::adjacent_find(touches, {}, [](const Touch& touch) {
                             return touch.contact.particle;
                         }) != touches.end();
    if (several) drop_loose(touches);
    for_each_group(touches, [&](Group group) {
        if (group.size() == 1) {
            Touch& touch = group.front();
            constrain_single(solids[touch.contact.solid].friction, view, touch, constraints, base, impulse);
        } else {
            constrain_group(solids, view, group, constraints, base, impulse);
        }
    });
}

void judge_touches(std::span<const Solid> solids, const StepView& view, const Constraints& constraints,
                   std::span<const Vec3> reaction, std::span<Touch> touches, std::vector<Contact>& out) {
    out.clear();
    std::vector<double> along;
    for_each_group(touches, [&](Group group) {
        const std::uint32_t p = group.front().contact.particle;
        const Constraint* constraint = constraints.find(p);
        const Vec3 force =
            reaction[static_cast<std::size_t>(constraint - constraints.all().data())] / view.h_force;
        const double nothing = pull_share * view.mass[p] * view.gravity.norm();
        along.resize(group.size());
        split_force(group, force, along);
        for (std::size_t t = 0; t < group.size(); ++t) {
            const Friction& friction = solids[group[t].contact.solid].friction;
            out.push_back(judge(friction, group[t], force, along[t], nothing));
        }
    });
}

}  // namespace unravel::sim
