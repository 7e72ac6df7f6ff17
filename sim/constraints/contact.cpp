#include "sim/constraints/contact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/constraints/near_solids.hpp"
#include "sim/constraints/touch_groups.hpp"

namespace unravel::sim {

namespace {

// A particle is caught when it would end this share of the offset inside: without it, a particle released at
// rounding distance is caught again at once.
constexpr double catch_share = 0.01;
// Depth is corrected at most this fast [m/s].
constexpr double correction_speed = 0.5;
// Two contacts pinch where their normals' cosine is below this.
constexpr double pinch_cosine = -0.5;
// A gap below this is rounding [m]: what rests then rests to the last bit, and asks for nothing.
constexpr double no_gap = 1e-12;
// What let go with a pull of this many times its weight is not caught again by its weight.
constexpr double strong_pull = 10;

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
        touch.is_new = false;
        // One that has opened but is about to be run over again is still a contact; one that would open
        // though it is pressed as it was is none: it goes round an edge, or is thrown off.
        const double pressed = touch.gap + view.step * (touch.normal.dot(view.v[p] - touch.velocity) - push);
        return catches || (touch.gap < open_share * solid.offset && pressed < catch_share * solid.offset);
    }
    // No force has been felt yet; friction reckons with what it takes to stop the particle at the surface.
    touch.contact.force = view.mass[p] * std::max(-ahead, 0.0) / (view.step * view.step);
    return catches;
}

// Whether two solids pinch a particle: they leave it less room than it takes.
bool opposed(const Touch& a, const Touch& b) {
    return a.normal.dot(b.normal) < pinch_cosine && a.gap + b.gap < 0;
}

// Between two solids that leave it room a particle touches the nearer one.
void drop_loose(std::vector<Touch>& touches) {
    std::vector<Touch> kept;
    kept.reserve(touches.size());
    for_each_group(std::span(touches), [&](Group group) {
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

// The vector of span(N) with given components along N's columns.
template <typename Matrix>
Vec3 with_components(const Matrix& N, const Eigen::VectorXd& c) {
    return N * (N.transpose() * N).eval().ldlt().solve(c);
}

// Velocity that a solid's own gives to v' so that x' follows the solid over the step; 1 for one-step schemes.
double carry(const StepView& view) {
    return view.step / view.h;
}

// Nearly every touching particle touches once: one normal, no linear algebra.
void constrain_single(const StepView& view, const Touch& touch, std::span<const Vec3> base,
                      Constraints& constraints) {
    const std::uint32_t p = touch.contact.particle;
    const Vec3& n = touch.normal;
    Constraint c;
    c.particle = p;
    c.z = (view.x[p] - base[p]) / view.h + carry(view) * touch.velocity + closing(touch, view.h) - view.v[p];
    if (!touch.contact.held) {
        c.free = 2;
        c.S = Mat3::Identity() - n * n.transpose();
        c.z = n.dot(c.z) * n;
    }
    constraints.add(c);
}

bool is_pinched(std::span<const Touch> group) {
    return std::ranges::any_of(group, [](const Touch& t) { return t.pinched; });
}

// A pinch between solids of which any is rough holds the particle, however hard it is pulled.
bool is_gripped(std::span<const Solid> solids, std::span<const Touch> group) {
    const auto rough = [&](const Touch& t) { return solids[t.contact.solid].friction.static_ > 0; };
    return is_pinched(group) && std::ranges::any_of(group, rough);
}

bool all_taken(const Eigen::Matrix3d& N) {
    return std::abs(N.determinant()) > 1e-6;
}

// Smooth solids hold what they pinch in the middle between them, and let it slide there. Along direction n of
// a pinch: the mean of f(touch, n) over its sides.
template <typename F>
double mean_of_pinch(std::span<const Touch> group, const Vec3& n, const F& f) {
    double sum = 0;
    int sides = 0;
    for (const Touch& touch : group) {
        if (!same_direction(n, touch.normal) && !same_direction(n, -touch.normal)) continue;
        sum += f(touch);
        ++sides;
    }
    return sum / sides;
}

void constrain_group(std::span<const Solid> solids, const StepView& view, std::span<const Touch> group,
                     std::span<const Vec3> base, Constraints& constraints) {
    const std::uint32_t p = group.front().contact.particle;
    const bool held = std::ranges::any_of(group, [](const Touch& t) { return t.contact.held; });
    auto N = taken_directions(group);
    Constraint c;
    c.particle = p;
    const Vec3 from_base = (view.x[p] - base[p]) / view.h;
    const auto riding = [&](const Touch& touch) { return from_base + carry(view) * touch.velocity; };
    if (held || is_gripped(solids, group) || (N.cols() == 3 && all_taken(N))) {
        // Rides on what holds it: the held contacts' solids, or all of them in a pinch.
        Vec3 ride = Vec3::Zero(), close = Vec3::Zero();
        int riders = 0;
        for (const Touch& touch : group) {
            close += closing(touch, view.h);
            if (!touch.contact.held && held) continue;
            ride += touch.velocity;
            ++riders;
        }
        if (is_pinched(group)) close.setZero();
        c.free = 0;
        c.z = from_base + carry(view) / riders * ride + close - view.v[p];
    } else {
        if (N.cols() == 3) N.conservativeResize(3, 2);
        Eigen::VectorXd speed(N.cols());
        speed.setConstant(-std::numeric_limits<double>::infinity());
        for (const Touch& touch : group) {
            for (Eigen::Index k = 0; k < N.cols(); ++k) {
                const Vec3 n = N.col(k);
                if (!same_direction(n, touch.normal)) continue;
                const double own =
                    touch.pinched ? mean_of_pinch(group, n, [&](const Touch& t) { return n.dot(riding(t)); })
                                  : touch.normal.dot(riding(touch) + closing(touch, view.h));
                speed[k] = std::max(speed[k], own);
            }
        }
        c.free = static_cast<std::uint8_t>(3 - N.cols());
        c.S = Mat3::Identity() - N * (N.transpose() * N).eval().ldlt().solve(Eigen::MatrixXd(N.transpose()));
        c.S = 0.5 * (c.S + c.S.transpose()).eval();
        c.z = with_components(N, speed - N.transpose() * view.v[p]);
    }
    constraints.add(c);
}

// How far a group's particle is put out of what it is too deep in.
Vec3 group_correction(std::span<const Solid> solids, const StepView& view, std::span<const Touch> group) {
    const double limit = correction_speed * view.h;
    if (is_gripped(solids, group)) {
        // Depths of opposing normals average to the middle of the gap.
        Vec3 depth = Vec3::Zero();
        for (const Touch& touch : group) depth -= touch.gap * touch.normal;
        depth /= static_cast<double>(group.size());
        return depth.norm() > limit ? Vec3(limit / depth.norm() * depth) : depth;
    }
    auto N = taken_directions(group);
    if (N.cols() == 3 && !all_taken(N)) N.conservativeResize(3, 2);
    Eigen::VectorXd depth = Eigen::VectorXd::Zero(N.cols());
    for (Eigen::Index k = 0; k < N.cols(); ++k) {
        const Vec3 n = N.col(k);
        for (const Touch& touch : group) {
            if (!same_direction(n, touch.normal)) continue;
            if (touch.pinched) {
                const auto way = [&](const Touch& t) { return -t.gap * n.dot(t.normal); };
                depth[k] = std::clamp(mean_of_pinch(group, n, way), -limit, limit);
            } else {
                depth[k] = std::max(depth[k], depth_correction(touch, view.h).norm());
            }
        }
    }
    return with_components(N, depth);
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

void settle_touches(std::span<const Solid> solids, const StepView& view, std::vector<Touch>& touches,
                    std::span<Vec3> base) {
    const bool several = std::ranges::adjacent_find(touches, {}, [](const Touch& touch) {
                             return touch.contact.particle;
                         }) != touches.end();
    if (several) drop_loose(touches);
    for_each_group(std::span(touches), [&](Group group) {
        const std::uint32_t p = group.front().contact.particle;
        if (group.size() == 1) {
            base[p] += depth_correction(group.front(), view.h);
            return;
        }
        for (Touch& touch : group)
            touch.pinched = std::ranges::any_of(group, [&](const Touch& t) { return opposed(touch, t); });
        base[p] += group_correction(solids, view, group);
    });
}

void constrain_touches(std::span<const Solid> solids, const StepView& view, std::span<const Touch> touches,
                       std::span<const Vec3> base, Constraints& constraints) {
    for_each_group(touches, [&](std::span<const Touch> group) {
        if (group.size() == 1) {
            constrain_single(view, group.front(), base, constraints);
        } else {
            constrain_group(solids, view, group, base, constraints);
        }
    });
}

}  // namespace unravel::sim
