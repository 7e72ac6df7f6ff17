#include "sim/self_collision/keep_apart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/surface/impact.hpp"

namespace unravel::sim {

namespace {

// What is kept between surfaces within a step is kept_share of the thickness; and this of what there is at
// the start where that is less.
constexpr double kept_of_distance = 0.5;
// Impacts end with this share of the thickness between them, at most with what they had.
constexpr double end_share = 0.2, end_of_distance = 0.9;
// Sweeps over impacts before groups move as one, and sweeps altogether.
constexpr int most_sweeps = 24, most_rounds = 200;
// Pairs that answer a push by less than this share of what they would if nothing held them are not pushed:
// what is left to move is far from where they meet, and would be flung.
constexpr double least_softness = 0.1;
// Features this near touch already: they cross, or a seam has brought them together; nothing is kept of them.
constexpr double touching = 1e-12;

struct Impacts {
    const ClothModel& model;
    std::span<const Vec3> x;
    const Constraints& constraints;
    std::span<const std::uint8_t> fixed;
    const PairWatch& pairs;
    KeepApartWorkspace& ws;

    std::size_t size() const { return pairs.vertex_triangle.size() + pairs.edge_edge.size(); }
    bool is_vertex(std::size_t k) const { return k < pairs.vertex_triangle.size(); }
    FeaturePair kind(std::size_t k) const {
        return is_vertex(k) ? FeaturePair::vertex_triangle : FeaturePair::edge_edge;
    }
    std::array<std::uint32_t, 4> corners(std::size_t k) const {
        return corners_of(
            model.contact->surface, kind(k),
            is_vertex(k) ? pairs.vertex_triangle[k] : pairs.edge_edge[k - pairs.vertex_triangle.size()]);
    }
    std::array<Vec3, 4> of(std::span<const Vec3> y, const std::array<std::uint32_t, 4>& p) const {
        return {y[p[0]], y[p[1]], y[p[2]], y[p[3]]};
    }

    // Pairs that meet, of those of which a particle has moved since they were last looked at.
    void find() {
        ws.found.resize(chunk_count(size()));
        parallel_chunks(size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
            ws.found[chunk].clear();
            for (std::size_t k = begin; k < end; ++k) {
                const std::array<std::uint32_t, 4> p = corners(k);
                if (!ws.moved[p[0]] && !ws.moved[p[1]] && !ws.moved[p[2]] && !ws.moved[p[3]]) continue;
                const std::array<Vec3, 4> at = of(x, p), d = of(ws.step, p);
                const double thickness = model.contact->pair_thickness(p[0], p[3]);
                if (stays_clear(kind(k), at, d, kept_share * thickness)) continue;
                if (meets(k, at, d, thickness)) ws.found[chunk].push_back(static_cast<std::uint32_t>(k));
            }
        });
        ws.impacts.clear();
        for (const std::vector<std::uint32_t>& part : ws.found)
            ws.impacts.insert(ws.impacts.end(), part.begin(), part.end());
        std::fill(ws.moved.begin(), ws.moved.end(), std::uint8_t{0});
    }

    bool meets(std::size_t k, const std::array<Vec3, 4>& at, const std::array<Vec3, 4>& d,
               double thickness) const {
        const double distance = combined(weights_of(kind(k), at), at).norm();
        if (distance <= touching) return false;
        return time_of_impact(kind(k), at, d, kept(distance, thickness)) < 1;
    }
    static double kept(double distance, double thickness) {
        return std::min(kept_share * thickness, kept_of_distance * distance);
    }

    // How a particle answers a push of a kilogram metre along n. [1/kg]
    Vec3 answer(std::uint32_t p, const Vec3& n) const {
        const Constraint* c = constraints.find(p);
        if (!c) return n / model.mass[p];
        return c->S * n / model.mass[p];
    }

    // Stops one pair along the line between its nearest points where it would meet.
    void stop(std::size_t k) {
        const std::array<std::uint32_t, 4> p = corners(k);
        const std::array<Vec3, 4> at = of(x, p), d = of(ws.step, p);
        const double thickness = model.contact->pair_thickness(p[0], p[3]);
        const double distance = combined(weights_of(kind(k), at), at).norm();
        if (distance <= touching) return;
        const double t = time_of_impact(kind(k), at, d, kept(distance, thickness));
        if (t >= 1) return;
        std::array<Vec3, 4> meeting, ends;
        for (std::size_t i = 0; i < 4; ++i) {
            meeting[i] = at[i] + t * d[i];
            ends[i] = at[i] + d[i];
        }
        const Weights w = weights_of(kind(k), meeting);
        const Vec3 n = combined(w, meeting).normalized();
        const double target = std::min(end_share * thickness, end_of_distance * distance);
        const double lacking = target - n.dot(combined(w, ends));
        double softness = 0, free = 0;
        std::array<Vec3, 4> answers;
        for (std::size_t i = 0; i < 4; ++i) {
            answers[i] = w[i] * answer(p[i], n);
            softness += w[i] * n.dot(answers[i]);
            free += w[i] * w[i] / model.mass[p[i]];
        }
        if (softness < least_softness * free || lacking <= 0) return ride_together(p);
        for (std::size_t i = 0; i < 4; ++i) ws.step[p[i]] += lacking / softness * answers[i];
    }

    // What meets on the way and not at the end, or can only be moved against what holds it, goes as one.
    void ride_together(const std::array<std::uint32_t, 4>& p) {
        Vec3 sum = Vec3::Zero(), held = Vec3::Zero();
        double mass = 0;
        int holds = 0;
        for (const std::uint32_t q : p) {
            sum += model.mass[q] * ws.step[q];
            mass += model.mass[q];
            if (!fixed[q]) continue;
            held += ws.step[q];
            ++holds;
        }
        const Vec3 ride = holds > 0 ? Vec3(held / holds) : Vec3(sum / mass);
        for (const std::uint32_t q : p) {
            if (!fixed[q]) ws.step[q] = ride;
        }
    }

    std::uint32_t root(std::uint32_t p) {
        while (ws.zone[p] != p) p = ws.zone[p] = ws.zone[ws.zone[p]];
        return p;
    }

    // Particles of impacts that go on join a zone, and each zone moves as its mass does, or as what is held
    // in it.
    void move_as_one(Apart& report) {
        if (ws.zone.empty()) {
            ws.zone.resize(x.size());
            std::iota(ws.zone.begin(), ws.zone.end(), 0u);
        }
        for (const std::uint32_t k : ws.impacts) {
            const std::array<std::uint32_t, 4> p = corners(k);
            for (std::size_t i = 1; i < 4; ++i) {
                const std::uint32_t a = root(p[0]), b = root(p[i]);
                ws.zone[std::max(a, b)] = std::min(a, b);
            }
        }
        std::vector<std::uint32_t> roots;
        for (const std::uint32_t k : ws.impacts) roots.push_back(root(corners(k)[0]));
        std::sort(roots.begin(), roots.end());
        roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
        report.zones = std::max(report.zones, static_cast<std::uint32_t>(roots.size()));
        std::vector<Vec3> free(roots.size(), Vec3::Zero()), held(roots.size(), Vec3::Zero());
        std::vector<double> mass(roots.size(), 0.0);
        std::vector<int> holds(roots.size(), 0);
        const auto zone_of = [&](std::uint32_t p) {
            const auto at = std::lower_bound(roots.begin(), roots.end(), root(p));
            return at != roots.end() && *at == root(p) ? at - roots.begin() : std::ptrdiff_t{-1};
        };
        for (std::uint32_t p = 0; p < x.size(); ++p) {
            const std::ptrdiff_t z = zone_of(p);
            if (z < 0) continue;
            const auto at = static_cast<std::size_t>(z);
            free[at] += model.mass[p] * ws.step[p];
            mass[at] += model.mass[p];
            if (!fixed[p]) continue;
            held[at] += ws.step[p];
            ++holds[at];
        }
        for (std::uint32_t p = 0; p < x.size(); ++p) {
            const std::ptrdiff_t z = zone_of(p);
            if (z < 0 || fixed[p]) continue;
            const auto at = static_cast<std::size_t>(z);
            const Vec3 step = holds[at] > 0 ? Vec3(held[at] / holds[at]) : Vec3(free[at] / mass[at]);
            if (step == ws.step[p]) continue;
            ws.step[p] = step;
            ws.moved[p] = 1;
        }
    }
};

}  // namespace

Apart keep_apart(const ClothModel& model, std::span<const Vec3> x, const Constraints& constraints,
                 std::span<const std::uint8_t> fixed, std::span<Vec3> end, SurfaceContactWorkspace& ws,
                 KeepApartWorkspace& scratch) {
    Apart report;
    scratch.step.resize(x.size());
    parallel_each(x.size(), [&](std::size_t p) { scratch.step[p] = end[p] - x[p]; });
    scratch.moved.assign(x.size(), 1);
    scratch.zone.clear();
    Impacts impacts{model, x, constraints, fixed, ws.watch, scratch};
    for (int round = 0;; ++round) {
        // Impacts send particles where others may be, and pairs that slept.
        watch_pairs(model, x, end, ws);
        impacts.find();
        if (round == 0) report.impacts = static_cast<std::uint32_t>(scratch.impacts.size());
        if (scratch.impacts.empty()) return report;
        if (round >= most_rounds) {
            report.kept = false;
            report.particles = impacts.corners(scratch.impacts.front());
            return report;
        }
        if (round < most_sweeps) {
            for (const std::uint32_t k : scratch.impacts) impacts.stop(k);
        } else {
            impacts.move_as_one(report);
        }
        // Whether moved or not: what meets is looked at again.
        for (const std::uint32_t k : scratch.impacts) {
            for (const std::uint32_t p : impacts.corners(k)) scratch.moved[p] = 1;
        }
        parallel_each(x.size(), [&](std::size_t p) {
            if (scratch.moved[p] && !fixed[p]) end[p] = x[p] + scratch.step[p];
        });
    }
}

}  // namespace unravel::sim
