#include "sim/self_collision/surface_contact.hpp"

#include <algorithm>
#include <cmath>

#include "sim/self_collision/contact_stencil.hpp"

namespace unravel::sim {

namespace {

// A contact that is not closed yet is one when it would close by more than this share of the thickness.
constexpr double closing_share = 0.01;
// Pairs are searched for around the way of this many steps, and beyond it around a thickness or this share of
// the edges there, whichever is more: forces turn particles from the way that they seemed to go, by more than
// thin cloth is thick, and neighbours come into it only where it is as wide as edges are long.
constexpr double steps_ahead = 4, share_of_edges = 0.2;
// Sine of the angle by which a face may rise from its edge towards the other edge.
constexpr double rising = 0.3;
// Sliding slower than this is rest, but for a creep [m/s].
constexpr double slow = 1e-3;
// Of critical damping, where the scene leaves it open.
constexpr double damping_share = 0.2;

// The nearest points of a vertex and a triangle may lie on an edge or a corner that other triangles share:
// one of them has the contact, and none where the vertex is nearer to the inside of another.
bool owns_vertex_contact(const Surface& surface, std::span<const Vec3> x, std::uint32_t p, std::uint32_t t,
                         const Weights& w) {
    const auto& corners = surface.triangles[t];
    std::array<std::size_t, 3> on{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (w[k + 1] != 0) on[count++] = k;
    }
    if (count == 3) return true;
    // Every triangle around must see the vertex nearest to the same feature.
    const auto agrees = [&](std::uint32_t other) {
        const auto& c = surface.triangles[other];
        const Vec3 weights = closest_on_triangle(x[p], x[c[0]], x[c[1]], x[c[2]]);
        for (std::size_t k = 0; k < 3; ++k) {
            bool shared = false;
            for (std::size_t i = 0; i < count; ++i) shared = shared || c[k] == corners[on[i]];
            if (!shared && weights[static_cast<Eigen::Index>(k)] != 0) return false;
        }
        return true;
    };
    const std::uint32_t a = corners[on[0]];
    if (count == 1 && p > a) {
        // Two vertices: the smaller one has the contact, where it has a triangle to have it with.
        if (!surface.triangles_at.of(p).empty()) return false;
    }
    for (const std::uint32_t other : surface.triangles_at.of(a)) {
        const auto& c = surface.triangles[other];
        const bool around = count == 1 || std::find(c.begin(), c.end(), corners[on[1]]) != c.end();
        if (around && other != t && (other < t || !agrees(other))) return false;
    }
    return true;
}

// Whether the surface around an edge keeps behind it as seen from the other: where a face rises towards it,
// that face is the nearer one. `to` points from the edge's point `at` to the other.
bool faces_edge(const Surface& surface, std::span<const Vec3> x, std::uint32_t e, const Vec3& at,
                const Vec3& to) {
    const auto& edge = surface.edges[e];
    for (const std::uint32_t t : surface.sides[e]) {
        if (t == Surface::none) continue;
        for (const std::uint32_t p : surface.triangles[t]) {
            if (p == edge[0] || p == edge[1]) continue;
            const Vec3 inward = x[p] - at;
            const double rise = inward.dot(to);
            if (rise > 0 && rise * rise > rising * rising * inward.squaredNorm() * to.squaredNorm())
                return false;
        }
    }
    return true;
}

// The mean of all particles' ways. [m]
Vec3 mean_motion(std::span<const Vec3> from, std::span<const Vec3> to) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < from.size(); ++p) sum += to[p] - from[p];
    return from.empty() ? sum : Vec3(sum / static_cast<double>(from.size()));
}

struct Finder {
    const ClothModel& model;
    std::span<const Vec3> x, v, ahead;
    double h, threshold;

    bool try_pair(FeaturePair kind, const std::array<std::uint32_t, 2>& pair, SurfaceContact& out,
                  double& least) const {
        const Surface& surface = model.contact->surface;
        const std::array<std::uint32_t, 4> p = corners_of(surface, kind, pair);
        std::array<Vec3, 4> at, way;
        for (std::size_t k = 0; k < 4; ++k) {
            at[k] = x[p[k]];
            way[k] = ahead[p[k]] - at[k];
        }
        const double thickness = model.contact->pair_thickness(p[0], p[3]);
        if (stays_clear(kind, at, way, thickness)) return false;
        const Weights w = weights_of(kind, at);
        const Vec3 r = combined(w, at);
        const double distance = r.norm();
        const Vec3 normal = distance > 0 ? Vec3(r / distance) : Vec3::UnitY();
        double end = 0;
        for (std::size_t k = 0; k < 4; ++k) end += w[k] * normal.dot(ahead[p[k]]);
        const bool closed = distance < thickness;
        if (!closed && end > (1 - closing_share) * thickness) return false;
        if (model.contact->are_near(kind, p)) return false;
        if (kind == FeaturePair::edge_edge) {
            // At an edge's end it is the end's contact with a triangle.
            if (w[0] == 0 || w[1] == 0 || w[2] == 0 || w[3] == 0) return false;
            const Vec3 first = w[0] * at[0] + w[1] * at[1];
            if (!faces_edge(surface, x, pair[0], first, -r) || !faces_edge(surface, x, pair[1], first - r, r))
                return false;
        } else if (!owns_vertex_contact(surface, x, p[0], pair[1], w)) {
            return false;
        }
        least = std::min(least, distance);
        if (end > thickness) return false;
        Stencil& c = out.stencil;
        c.p = p;
        c.count = 4;
        c.w = w;
        c.u = normal;
        ContactPush push;
        push.lacking = push.depth = opened_within(h, thickness - distance);
        push.depth_ahead = std::min(distance, thickness) - end;
        double inverse_mass = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            inverse_mass += w[k] * w[k] / model.mass[p[k]];
            push.speed += w[k] * v[p[k]];
        }
        push.stiffness = model.contact->stiffness;
        push.damping = model.contact->damping;
        push.friction = model.contact->friction;
        press(push, inverse_mass, h, threshold, out);
        return true;
    }
};

// Which contacts each particle has a part in, in order.
void list_by_particle(std::size_t particles, SurfaceContactWorkspace& ws) {
    Lists& out = ws.at;
    out.start.assign(particles + 1, 0);
    for (const Stencil& c : ws.stencils) {
        for (std::uint32_t i = 0; i < c.count; ++i) ++out.start[c.p[i] + 1];
    }
    for (std::size_t p = 0; p < particles; ++p) out.start[p + 1] += out.start[p];
    out.list.resize(out.start.back());
    for (std::size_t k = ws.stencils.size(); k-- > 0;) {
        for (std::size_t i = ws.stencils[k].count; i-- > 0;) {
            // Filled from the back: each start ends where it was.
            out.list[--out.start[ws.stencils[k].p[i] + 1]] = static_cast<std::uint32_t>(4 * k + i);
        }
    }
    for (std::size_t p = 0; p < particles; ++p) out.start[p] = out.start[p + 1];
    out.start[particles] = static_cast<std::uint32_t>(out.list.size());
}

}  // namespace

void press(const ContactPush& push, double inverse_mass, double h, double threshold, SurfaceContact& out) {
    Stencil& c = out.stencil;
    c.along = push.stiffness;
    c.damping_along =
        push.damping > 0 ? push.damping : damping_share * 2.0 * std::sqrt(push.stiffness / inverse_mass);
    // The load of what rests, and what stops an impact within the step.
    const double load = std::max(
        {push.stiffness * push.depth, 0.0, push.depth_ahead / (h * h * inverse_mass + 1.0 / push.stiffness)});
    const double closing = c.u.dot(push.speed);
    const Vec3 slip = push.speed - closing * c.u;
    const double pace = slip.norm();
    const double mu = pace > slow ? push.friction.kinetic : push.friction.static_;
    c.damping_across = mu * load / std::max(pace, slow);
    const double k = kappa(h, inverse_mass, c.along, c.damping_along + c.damping_across);
    out.state = k <= threshold ? SpringState::explicit_ : SpringState::implicit;
    double along = push.stiffness * push.lacking - c.damping_along * closing;
    // What is treated explicitly never pulls, nor turns what slides; what is solved for may at the start, so
    // as not to at the end.
    if (out.state == SpringState::explicit_) {
        along = std::max(along, 0.0);
        c.damping_across = std::min(c.damping_across, 1.0 / (h * inverse_mass));
    }
    out.force = along * c.u - c.damping_across * slip;
    out.solid = -1;
}

void add_found(SurfaceContactWorkspace& ws) {
    for (const std::vector<SurfaceContact>& part : ws.found) {
        for (const SurfaceContact& contact : part) {
            ws.stencils.push_back(contact.stencil);
            ws.force.push_back(contact.force);
            ws.state.push_back(contact.state);
            ws.solid.push_back(contact.solid);
        }
    }
}

void begin_contacts(SurfaceContactWorkspace& ws) {
    ws.stencils.clear();
    ws.force.clear();
    ws.state.clear();
    ws.solid.clear();
    ws.least_distance = 0;
}

void end_contacts(std::size_t particles, SurfaceContactWorkspace& ws) {
    list_by_particle(particles, ws);
}

namespace {

void place_margins(const ContactModel& contact, std::span<const Vec3> x, std::vector<double>& margin) {
    const Surface& surface = contact.surface;
    margin.resize(x.size());
    parallel_each(x.size(), [&](std::size_t p) {
        const std::span<const std::uint32_t> edges = surface.edges_at.of(static_cast<std::uint32_t>(p));
        double length = 0;
        for (const std::uint32_t e : edges)
            length += (x[surface.edges[e][0]] - x[surface.edges[e][1]]).norm();
        if (!edges.empty()) length /= static_cast<double>(edges.size());
        margin[p] = std::max(contact.thickness[surface.cloth[p]], share_of_edges * length);
    });
}

// Finds all pairs that can come within their thickness while particles go from x towards `ahead`, and on at
// that pace for a few steps, and a margin around that way.
void search_pairs(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> ahead,
                  SurfaceContactWorkspace& ws) {
    const ContactModel& contact = *model.contact;
    if (ws.model != model.contact) {
        ws.model = model.contact;
        ws.tree = contact.tree;
        place_margins(contact, x, ws.margin);
    }
    // Motion that all share brings nothing nearer to anything.
    const Vec3 ride = mean_motion(x, ahead);
    const std::size_t n = x.size();
    ws.searched.assign(x.begin(), x.end());
    ws.boxes.resize(n);
    std::vector<Box> reaching(n);
    parallel_each(n, [&](std::size_t p) {
        const double thickness = contact.thickness[contact.surface.cloth[p]];
        const Vec3 way = steps_ahead * (ahead[p] - x[p] - ride);
        const Vec3 margin = Vec3::Constant(ws.margin[p]), reach = Vec3::Constant(0.5 * thickness);
        const Vec3 end = x[p] + way;
        ws.boxes[p] = {x[p].cwiseMin(end) - margin, x[p].cwiseMax(end) + margin};
        reaching[p] = {ws.boxes[p].low - reach, ws.boxes[p].high + reach};
    });
    ws.tree.refit(contact.surface, reaching);
    find_pairs(contact.surface, ws.tree, ws.pairs);
    ws.watch.begin(contact.surface, ws.tree, ws.pairs, x,
                   [&](FeaturePair kind, const std::array<std::uint32_t, 2>& pair) {
                       const std::array<std::uint32_t, 4> p = corners_of(contact.surface, kind, pair);
                       const double thickness = contact.pair_thickness(p[0], p[3]);
                       return contact.are_near(kind, p) ? kept_share * thickness : thickness;
                   });
}

// Whether all particles go from x to `end` within their boxes of the last search, so that it missed no pair.
bool within_search(std::span<const Vec3> x, std::span<const Vec3> end, const SurfaceContactWorkspace& ws) {
    if (ws.boxes.size() != x.size()) return false;
    const auto holds = [](const Box& box, const Vec3& at) {
        return (at.array() >= box.low.array()).all() && (at.array() <= box.high.array()).all();
    };
    const Vec3 ridden = mean_motion(ws.searched, x), ride = mean_motion(ws.searched, end);
    for (std::size_t p = 0; p < end.size(); ++p) {
        if (!holds(ws.boxes[p], x[p] - ridden) || !holds(ws.boxes[p], end[p] - ride)) return false;
    }
    return true;
}

}  // namespace

void watch_pairs(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> end,
                 SurfaceContactWorkspace& ws) {
    if (ws.model != model.contact || !within_search(x, end, ws)) search_pairs(model, x, end, ws);
    ws.watch.wake(model.contact->surface, ws.tree, ws.pairs, x, end);
}

void find_contacts(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> v,
                   std::span<const Vec3> ahead, double h, double threshold, SurfaceContactWorkspace& ws) {
    watch_pairs(model, x, ahead, ws);
    const Finder finder{model, x, v, ahead, h, threshold};
    const PairList& vt = ws.watch.vertex_triangle;
    const PairList& ee = ws.watch.edge_edge;
    const std::size_t pairs = vt.size() + ee.size();
    ws.found.resize(chunk_count(pairs));
    double thickest = 0;
    for (const double t : model.contact->thickness) thickest = std::max(thickest, t);
    std::vector<double> least(std::max<std::size_t>(chunk_count(pairs), 1), thickest);
    parallel_chunks(pairs, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        ws.found[chunk].clear();
        SurfaceContact contact;
        for (std::size_t k = begin; k < end; ++k) {
            const bool vertex = k < vt.size();
            if (finder.try_pair(vertex ? FeaturePair::vertex_triangle : FeaturePair::edge_edge,
                                vertex ? vt[k] : ee[k - vt.size()], contact, least[chunk]))
                ws.found[chunk].push_back(contact);
        }
    });
    add_found(ws);
    ws.least_distance = *std::min_element(least.begin(), least.end());
}

}  // namespace unravel::sim
