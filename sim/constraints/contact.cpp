#include "sim/constraints/contact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/constraints/touch_groups.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

// A particle is caught when it would end this share of the offset inside: without it, a particle released at
// rounding distance is caught again at once.
constexpr double catch_share = 0.01;
// A contact that has opened by this share of the offset is over.
constexpr double open_share = 0.5;
// Depth is corrected at most this fast [m/s].
constexpr double correction_speed = 0.5;
// Two contacts pinch where their normals' cosine is below this.
constexpr double pinch_cosine = -0.5;
// A gap below this is rounding [m]: what rests then rests to the last bit, and asks for nothing.
constexpr double no_gap = 1e-12;
// A contact that let go with a pull of this many times the particle's weight is not caught again by its
// weight.
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
    if (!solid.motion.empty() || deformed) touch.velocity = (next * surface.carried - view.x[p]) / view.step;
    touch.pinched = false;
    // Gravity is foreseen, so that what is laid on a slope is caught before it has begun to slide. Not of
    // what has just let go: the forces on it, gravity among them, pull it off, and catching it again before
    // it has moved would weld cloth that is pulled over an edge to it.
    const bool let_go = known && known->force < 0;
    const bool pulled_off = let_go && -known->force > strong_pull * view.mass[p] * view.gravity.norm();
    const Vec3 fall = pulled_off ? Vec3(Vec3::Zero()) : Vec3(view.step * view.gravity);
    const Vec3 coming = view.v[p] + fall - touch.velocity;
    const double ahead = touch.gap + view.step * touch.normal.dot(coming);
    const bool catches = ahead < -catch_share * solid.offset;
    if (known && !let_go) {
        touch.contact = *known;
        touch.is_new = false;
        // One that has opened but is about to be run over again is still a contact.
        return catches || touch.gap < open_share * solid.offset;
    }
    // No force has been felt yet; friction reckons with what it takes to stop the particle at the surface.
    touch.contact.force = view.mass[p] * std::max(-ahead, 0.0) / (view.step * view.step);
    return catches;
}

SolidReach reach_of(const Solid& solid, const Pose& now, const Pose& next) {
    SolidReach reach;
    reach.now = now.translation();
    reach.next = next.translation();
    reach.normal = now.linear().col(1);
    reach.radius = law_of(solid.shape).reach(solid);
    reach.plane = solid.shape == Shape::plane && solid.motion.empty();
    reach.travel = (reach.next - reach.now).norm();
    // Frobenius' norm of the difference is 2√2 sin(θ/2): more than θ for turns below 2.2, and at most 2√2.
    reach.turn = std::min((next.linear() - now.linear()).norm(), 1.0);
    reach.skin = (1.0 + open_share) * solid.offset;
    return reach;
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

bool all_taken(const Eigen::Matrix3d& N) {
    return std::abs(N.determinant()) > 1e-6;
}

void constrain_group(const StepView& view, std::span<const Touch> group, std::span<const Vec3> base,
                     Constraints& constraints) {
    const std::uint32_t p = group.front().contact.particle;
    const bool held = std::any_of(group.begin(), group.end(), [](const Touch& t) { return t.contact.held; });
    const bool pinched = std::any_of(group.begin(), group.end(), [](const Touch& t) { return t.pinched; });
    auto N = taken_directions(group);
    Constraint c;
    c.particle = p;
    const Vec3 from_base = (view.x[p] - base[p]) / view.h;
    if (held || pinched || (N.cols() == 3 && all_taken(N))) {
        // Rides on what holds it: the held contacts' solids, or all of them in a pinch.
        Vec3 ride = Vec3::Zero(), close = Vec3::Zero();
        int riders = 0;
        for (const Touch& touch : group) {
            close += closing(touch, view.h);
            if (!touch.contact.held && held) continue;
            ride += touch.velocity;
            ++riders;
        }
        if (pinched) close.setZero();
        c.free = 0;
        c.z = from_base + carry(view) / riders * ride + close - view.v[p];
    } else {
        if (N.cols() == 3) N.conservativeResize(3, 2);
        Eigen::VectorXd speed(N.cols());
        speed.setConstant(-std::numeric_limits<double>::infinity());
        for (const Touch& touch : group) {
            for (Eigen::Index k = 0; k < N.cols(); ++k) {
                if (!same_direction(N.col(k), touch.normal)) continue;
                speed[k] = std::max(speed[k], touch.normal.dot(from_base + carry(view) * touch.velocity +
                                                               closing(touch, view.h)));
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
Vec3 group_correction(const StepView& view, Group group) {
    const bool pinched = std::any_of(group.begin(), group.end(), [](const Touch& t) { return t.pinched; });
    if (pinched) {
        // Depths of opposing normals average to the middle of the gap.
        Vec3 depth = Vec3::Zero();
        for (const Touch& touch : group) depth -= touch.gap * touch.normal;
        depth /= static_cast<double>(group.size());
        const double limit = correction_speed * view.h;
        return depth.norm() > limit ? Vec3(limit / depth.norm() * depth) : depth;
    }
    auto N = taken_directions(group);
    if (N.cols() == 3 && !all_taken(N)) N.conservativeResize(3, 2);
    Eigen::VectorXd depth = Eigen::VectorXd::Zero(N.cols());
    for (const Touch& touch : group) {
        for (Eigen::Index k = 0; k < N.cols(); ++k) {
            if (same_direction(N.col(k), touch.normal))
                depth[k] = std::max(depth[k], depth_correction(touch, view.h).norm());
        }
    }
    return with_components(N, depth);
}

}  // namespace

void pose_solids(std::span<const Solid> solids, double t, double h, SolidPoses& out) {
    out.now.clear();
    out.next.clear();
    out.reach.clear();
    for (const Solid& solid : solids) {
        out.now.push_back(solid_pose(solid, t));
        out.next.push_back(solid_pose(solid, t + h));
        out.reach.push_back(reach_of(solid, out.now.back(), out.next.back()));
    }
    const auto deforms = [](const Solid& solid) { return solid.geometry && solid.geometry->deforms(); };
    if (std::none_of(solids.begin(), solids.end(), deforms)) return;
    out.deformed.resize(solids.size());
    for (std::size_t s = 0; s < solids.size(); ++s) {
        if (!deforms(solids[s])) continue;
        const MeshSolid& mesh = *solids[s].geometry;
        DeformedSolid& body = out.deformed[s];
        if (body.now.empty()) body.now = body.next = mesh.tree;
        std::swap(body.now, body.next);
        std::swap(body.positions_now, body.positions_next);
        if (body.t_next != t) {
            mesh.positions_at(t, body.positions_now);
            body.now.refit(body.positions_now);
        }
        mesh.positions_at(t + h, body.positions_next);
        body.next.refit(body.positions_next);
        body.t_next = t + h;
        body.moved = 0;
        for (std::size_t v = 0; v < body.positions_now.size(); ++v)
            body.moved = std::max(body.moved, (body.positions_next[v] - body.positions_now[v]).norm());
    }
}

const DeformedSolid* SolidPoses::of(const Solid& solid, std::size_t index) const {
    return solid.geometry && solid.geometry->deforms() ? &deformed[index] : nullptr;
}

void find_touches(std::span<const Solid> solids, const SolidPoses& poses, const StepView& view,
                  std::span<const Contact> known, const Constraints& pinned,
                  std::vector<std::vector<Touch>>& found, std::vector<Touch>& out) {
    out.clear();
    found.resize(chunk_count(view.x.size()));
    const double fall = view.step * view.gravity.norm();
    parallel_chunks(view.x.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        found[chunk].clear();
        auto next = std::lower_bound(known.begin(), known.end(), begin,
                                     [](const Contact& c, std::size_t p) { return c.particle < p; });
        for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
            while (next != known.end() && next->particle < p) ++next;
            if (pinned.find(p)) continue;
            const double ahead = view.step * (view.v[p].norm() + fall);
            for (std::uint32_t s = 0; s < solids.size(); ++s) {
                if (poses.reach[s].is_far(view.x[p], ahead)) continue;
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

void settle_depths(const StepView& view, std::span<Touch> touches, std::span<Vec3> base) {
    for_each_group(touches, [&](Group group) {
        const std::uint32_t p = group.front().contact.particle;
        if (group.size() == 1) {
            base[p] += depth_correction(group.front(), view.h);
            return;
        }
        for (Touch& touch : group) {
            for (const Touch& other : group)
                touch.pinched = touch.pinched || touch.normal.dot(other.normal) < pinch_cosine;
        }
        base[p] += group_correction(view, group);
    });
}

void constrain_touches(const StepView& view, std::span<Touch> touches, std::span<const Vec3> base,
                       Constraints& constraints) {
    for_each_group(touches, [&](Group group) {
        if (group.size() == 1) {
            constrain_single(view, group.front(), base, constraints);
        } else {
            constrain_group(view, group, base, constraints);
        }
    });
}

}  // namespace unravel::sim
