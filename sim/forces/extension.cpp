#include "sim/forces/extension.hpp"

#include <algorithm>
#include <cmath>

namespace unravel::sim {

void ExtensionForces::resize(std::size_t springs) {
    force.resize(springs);
    direction.resize(springs);
    transverse.resize(springs);
    state.resize(springs);
}

void extension_forces(const ExtensionSprings& springs, std::span<const double> mass, std::span<const Vec3> x,
                      std::span<const Vec3> v, double h, const Splitting& splitting, double band,
                      ExtensionForces& out, std::span<const std::uint8_t> taut, std::span<const Vec3> ahead) {
    out.resize(springs.size());
    parallel_each(springs.size(), [&](std::size_t s) {
        const std::uint32_t i = springs.i[s], j = springs.j[s];
        const double rest = springs.rest[s], reach = (1.0 - band) * rest;
        const double stiffness = springs.stiffness[s], damping = springs.damping[s];
        const bool bears = is_explicit(kappa_between(h, mass[i], mass[j], stiffness, damping),
                                       splitting.threshold(s < springs.stretch_count));
        const Vec3 now = x[j] - x[i];
        const bool looks_ahead = !bears && !ahead.empty();
        const Vec3 d = looks_ahead ? Vec3(ahead[j] - ahead[i]) : now;
        const double squared = d.squaredNorm();
        // What is taut now and slack ahead still resists: dropped, it would let the next step start
        // over-taut.
        const bool reached =
            squared > reach * reach || (looks_ahead && now.squaredNorm() > reach * reach && squared > 0);
        const bool joins = !taut.empty() && taut[s] != 0;
        const double length = reached || joins ? std::sqrt(squared) : 0.0;
        const SpringSplit split{bears, is_taut(length, rest), reached, joins, squared > 0};
        out.state[s] = split.state();
        out.force[s].setZero();
        if (split.state() == SpringState::inactive) return;
        const Vec3 u = d / length;
        out.direction[s] = u;
        out.transverse[s] = split.taut ? transverse_stiffness(stiffness, rest / length) : 0.0;
        if (!split.pulls()) return;
        // Damping acts along the spring at x: its Jacobian knows how it changes with velocity, not with the
        // spring's turning, so that taken elsewhere it would cost a second-order scheme its order.
        const Vec3 turned = looks_ahead && now.squaredNorm() > 0 ? Vec3(now.normalized()) : u;
        const SpringPull pull = spring_pull(stiffness, length - rest, damping, turned.dot(v[j] - v[i]));
        out.force[s] = pull.elastic * u + pull.damped * turned;
    });
}

bool mark_missed(const ExtensionSprings& springs, std::span<const double> mass, double h,
                 const Splitting& splitting, std::span<const Vec3> end, const ExtensionForces& forces,
                 double strain, std::vector<std::uint8_t>& taut) {
    taut.resize(springs.size(), 0);
    std::vector<std::uint8_t> found(chunk_count(springs.size()), 0);
    parallel_chunks(springs.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            if (taut[s] || forces.state[s] != SpringState::inactive) continue;
            const std::uint32_t i = springs.i[s], j = springs.j[s];
            const double rest = springs.rest[s], squared = (end[j] - end[i]).squaredNorm();
            if (!is_taut(squared, rest * rest)) continue;
            const double of_spring =
                kappa_between(h, mass[i], mass[j], springs.stiffness[s], springs.damping[s]);
            if (is_explicit(of_spring, splitting.threshold(s < springs.stretch_count))) continue;
            taut[s] = 1;
            const double longer = (1 + strain) * rest;
            if (is_taut(squared, longer * longer)) found[chunk] = 1;
        }
    });
    return std::find(found.begin(), found.end(), 1) != found.end();
}

void mark_taut(const ExtensionSprings& springs, std::span<const Vec3> end, std::vector<std::uint8_t>& taut) {
    taut.resize(springs.size());
    parallel_each(springs.size(), [&](std::size_t s) {
        const double rest = springs.rest[s];
        taut[s] = is_taut((end[springs.j[s]] - end[springs.i[s]]).squaredNorm(), rest * rest);
    });
}

Adjacency adjacency_of(std::size_t particles, std::span<const std::uint32_t> i,
                       std::span<const std::uint32_t> j) {
    Adjacency adjacency;
    adjacency.start.assign(particles + 1, 0);
    for (std::size_t s = 0; s < i.size(); ++s) {
        ++adjacency.start[i[s] + 1];
        ++adjacency.start[j[s] + 1];
    }
    for (std::size_t p = 0; p < particles; ++p) adjacency.start[p + 1] += adjacency.start[p];
    adjacency.entries.resize(2 * i.size());
    std::vector<std::uint32_t> next(adjacency.start.begin(), adjacency.start.end() - 1);
    for (std::uint32_t s = 0; s < i.size(); ++s) {
        adjacency.entries[next[i[s]]++] = {s, j[s]};
        adjacency.entries[next[j[s]]++] = {s, i[s]};
    }
    return adjacency;
}

}  // namespace unravel::sim
