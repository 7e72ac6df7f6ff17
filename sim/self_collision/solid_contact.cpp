#include "sim/self_collision/solid_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/self_collision/contact_stencil.hpp"

namespace unravel::sim {

namespace {

// Edges and faces are held off a solid by this share of its offset: particles, held off by all of it, leave
// what sags between them on a smooth solid to itself.
constexpr double held_share = 0.5;
// Contacts with solids are this many times as stiff as the cloth's stiffest thread: what pulls there is
// threads.
constexpr double stiffer = 10;
// A nearest point this near to a corner is the corner's.
constexpr double corner_share = 0.01;
// Golden sections: 1e-4 of an edge, 1e-3 of a triangle each way.
constexpr int edge_sections = 20, face_sections = 14;

// Where f, which has one minimum in [0, 1], is least.
template <typename F>
double least_at(int sections, const F& f) {
    constexpr double golden = 0.6180339887498949;
    double low = 0, high = 1, left = high - golden, right = low + golden;
    double at_left = f(left), at_right = f(right);
    for (int k = 0; k < sections; ++k) {
        if (at_left < at_right) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - golden * (high - low);
            at_left = f(left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + golden * (high - low);
            at_right = f(right);
        }
    }
    return 0.5 * (low + high);
}

// One solid, seen in its own frame at the step's start.
struct SolidView {
    const ClothModel& model;
    std::uint32_t number;
    const Solid& solid;
    const Pose &now, &next;
    std::span<const Vec3> x, v, foreseen;
    double h, threshold, stiffness;
    std::vector<Vec3> local, slope;  ///< (particles) where it is, and the distance's gradient there
    std::vector<Vec3> travel;        ///< (particles) how far it goes relative to the solid [m]
    std::vector<double> distance;    ///< (particles) m; unless `known`, a lower bound
    std::vector<Vec3> slope_end;     ///< (particles) as `slope`, where it would end
    std::vector<double> distance_end;
    std::vector<std::uint8_t> known;

    void place(const SolidReach& reach) {
        const std::size_t n = x.size();
        local.resize(n);
        slope.resize(n);
        travel.resize(n);
        distance.resize(n);
        known.resize(n);
        slope_end.resize(n);
        distance_end.resize(n);
        const Pose to_now = now.inverse(Eigen::Isometry), to_next = next.inverse(Eigen::Isometry);
        parallel_each(n, [&](std::size_t p) {
            local[p] = to_now * x[p];
            travel[p] = to_next * foreseen[p] - local[p];
            const double ball = std::isinf(reach.radius) ? 0.0 : local[p].norm() - reach.radius;
            known[p] = ball <= longest_edge(static_cast<std::uint32_t>(p)) + travel[p].norm();
            distance[p] = known[p] ? signed_distance(solid, local[p], &slope[p]) : ball;
            if (known[p]) distance_end[p] = signed_distance(solid, local[p] + travel[p], &slope_end[p]);
        });
    }
    double longest_edge(std::uint32_t p) const {
        const Surface& surface = model.contact->surface;
        double most = 0;
        for (const std::uint32_t e : surface.edges_at.of(p)) {
            const auto& [a, b] = surface.edges[e];
            most = std::max(most, (x[b] - x[a]).squaredNorm());
        }
        return std::sqrt(most) + solid.offset;
    }

    // Whether any point of a segment or triangle may come as near as it is held off: none is nearer than the
    // tangents of a convex distance say, neither now, less the way that its corners travel, nor at the end,
    // unless it has passed to another side by then.
    template <std::size_t N>
    bool may_touch(const std::array<std::uint32_t, N>& p) const {
        double least_now = -std::numeric_limits<double>::infinity(), least_end = least_now, way = 0;
        bool any = false, turns = false;
        for (std::size_t i = 0; i < N; ++i) {
            way = std::max(way, travel[p[i]].squaredNorm());
            if (!known[p[i]]) continue;
            any = true;
            turns = turns || slope[p[i]].dot(slope_end[p[i]]) <= 0;
            double now_i = distance[p[i]], end_i = distance_end[p[i]];
            for (std::size_t j = 0; j < N; ++j) {
                const Vec3 apart = local[p[j]] - local[p[i]];
                now_i = std::min(now_i, distance[p[i]] + slope[p[i]].dot(apart));
                end_i = std::min(
                    end_i, distance_end[p[i]] + slope_end[p[i]].dot(apart + travel[p[j]] - travel[p[i]]));
            }
            least_now = std::max(least_now, now_i);
            least_end = std::max(least_end, end_i);
        }
        const double held = held_share * solid.offset;
        return any && (turns || least_end < held) && least_now - std::sqrt(way) < held;
    }

    bool touch_edge(const std::array<std::uint32_t, 2>& p, SurfaceContact& out) const {
        if (!may_touch(p)) return false;
        const double s = least_at(edge_sections, [&](double t) {
            return signed_distance(solid, (1 - t) * local[p[0]] + t * local[p[1]]);
        });
        if (s < corner_share || s > 1 - corner_share) return false;
        return touch(std::array<std::uint32_t, 3>{p[0], p[1], p[0]}, {1 - s, s, 0}, 2, out);
    }
    bool touch_face(const std::array<std::uint32_t, 3>& p, SurfaceContact& out) const {
        if (!may_touch(p)) return false;
        const Vec3 &a = local[p[0]], &b = local[p[1]], &c = local[p[2]];
        const auto across = [&](double s) {
            return least_at(face_sections, [&](double t) {
                return signed_distance(solid, (1 - s) * a + s * ((1 - t) * b + t * c));
            });
        };
        const double s = least_at(face_sections, [&](double at) {
            const double t = across(at);
            return signed_distance(solid, (1 - at) * a + at * ((1 - t) * b + t * c));
        });
        const double t = across(s);
        const Vec3 w(1 - s, s * (1 - t), s * t);
        if (w.minCoeff() < corner_share) return false;
        return touch(p, w, 3, out);
    }

    bool touch(const std::array<std::uint32_t, 3>& p, const Vec3& w, std::uint32_t count,
               SurfaceContact& out) const {
        const auto mixed = [&](std::span<const Vec3> y) {
            Vec3 sum = w[0] * y[p[0]] + w[1] * y[p[1]];
            if (count == 3) sum += w[2] * y[p[2]];
            return sum;
        };
        const Vec3 at = mixed(local);
        Vec3 gradient;
        const double gap = signed_distance(solid, at, &gradient), held = held_share * solid.offset;
        // Along the normal of now: what is thin is not passed through for being behind the surface then.
        const double end = gap + gradient.dot(mixed(travel));
        if (end >= held) return false;
        for (std::uint32_t k = 0; k < count; ++k) {
            if (gap >= distance[p[k]]) return false;
        }
        Stencil& c = out.stencil;
        c = {};
        c.count = count;
        double inverse_mass = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            c.p[k] = p[k];
            c.w[k] = w[static_cast<Eigen::Index>(k)];
            inverse_mass += c.w[k] * c.w[k] / model.mass[p[k]];
        }
        c.u = now.linear() * gradient;
        const Vec3 ride = next * at - now * at;
        ContactPush push;
        push.depth = opened_within(h, held - gap);
        push.lacking = push.depth + c.u.dot(ride);
        push.depth_ahead = held - end;
        push.speed = mixed(v) - ride / h;
        push.stiffness = stiffness;
        push.friction = solid.friction;
        press(push, inverse_mass, h, threshold, out);
        out.solid = static_cast<std::int32_t>(number);
        return true;
    }
};

}  // namespace

void find_solid_contacts(const ClothModel& model, const SolidPoses& poses, std::span<const Vec3> x,
                         std::span<const Vec3> v, std::span<const Vec3> foreseen, double h, double threshold,
                         SurfaceContactWorkspace& ws) {
    const Surface& surface = model.contact->surface;
    const std::size_t edges = surface.edges.size(), features = edges + surface.triangles.size();
    for (std::uint32_t s = 0; s < model.solids.size(); ++s) {
        const Solid& solid = model.solids[s];
        if (!solid.by_surfaces()) continue;
        SolidView view{model,
                       s,
                       model.solids[s],
                       poses.now[s],
                       poses.next[s],
                       x,
                       v,
                       foreseen,
                       h,
                       threshold,
                       stiffer * model.contact->stiffness,
                       {},
                       {},
                       {},
                       {},
                       {},
                       {},
                       {}};
        view.place(poses.reach[s]);
        ws.found.resize(chunk_count(features));
        parallel_chunks(features, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
            ws.found[chunk].clear();
            SurfaceContact contact;
            for (std::size_t k = begin; k < end; ++k) {
                if (k < edges ? view.touch_edge(surface.edges[k], contact)
                              : view.touch_face(surface.triangles[k - edges], contact))
                    ws.found[chunk].push_back(contact);
            }
        });
        add_found(ws);
    }
}

void keep_edges_outside(const ClothModel& model, const SolidPoses& poses, const Constraints& constraints,
                        double h, const SurfaceContactWorkspace& ws, std::span<Vec3> x, std::span<Vec3> v) {
    for (std::size_t k = 0; k < ws.stencils.size(); ++k) {
        if (ws.solid[k] < 0) continue;
        const auto s = static_cast<std::size_t>(ws.solid[k]);
        const Stencil& c = ws.stencils[k];
        Vec3 at = Vec3::Zero(), speed = Vec3::Zero(), gradient;
        for (std::uint32_t i = 0; i < c.count; ++i) {
            at += c.w[i] * x[c.p[i]];
            speed += c.w[i] * v[c.p[i]];
        }
        const Vec3 local = poses.next[s].inverse(Eigen::Isometry) * at;
        const double distance = signed_distance(model.solids[s], local, &gradient);
        if (distance >= 0) continue;
        const Vec3 n = poses.next[s].linear() * gradient;
        const double closing = n.dot(speed - (at - poses.now[s] * local) / h);
        double softness = 0, free = 0;
        std::array<Vec3, 4> answer;
        for (std::uint32_t i = 0; i < c.count; ++i) {
            const Constraint* held = constraints.find(c.p[i]);
            answer[i] = c.w[i] / model.mass[c.p[i]] * (held ? Vec3(held->S * n) : n);
            softness += c.w[i] * n.dot(answer[i]);
            free += c.w[i] * c.w[i] / model.mass[c.p[i]];
        }
        if (softness < 0.1 * free) continue;  // what is left to move would be flung
        for (std::uint32_t i = 0; i < c.count; ++i) {
            x[c.p[i]] -= distance / softness * answer[i];
            if (closing < 0) v[c.p[i]] -= closing / softness * answer[i];
        }
    }
}

}  // namespace unravel::sim
