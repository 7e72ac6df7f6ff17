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
        const int mark = taut.empty() ? 0 : taut[s];
        const bool reached = squared > reach * reach || (mark == 2 && squared > 0) ||
                             (looks_ahead && now.squaredNorm() > reach * reach && squared > 0);
        const bool joins = mark == 1;
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

Misjudged correct_taut(const ExtensionSprings& springs, std::span<const double> mass, double h,
                       const Splitting& splitting, std::span<const Vec3> x, std::span<const Vec3> end,
                       const ExtensionForces& forces, double strain, std::vector<std::uint8_t>& taut) {
    taut.resize(springs.size(), 0);
    std::vector<Misjudged> found(chunk_count(springs.size()));
    parallel_chunks(springs.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            const std::uint32_t i = springs.i[s], j = springs.j[s];
            const double rest = springs.rest[s], stiffness = springs.stiffness[s];
            // Neither pulls nor pushes: what has its Jacobian alone, or is marked but has no line to act on.
            const bool left_out = forces.state[s] == SpringState::inactive;
            if (taut[s] != (left_out ? 0 : 1) || forces.state[s] == SpringState::explicit_) continue;
            const double squared = (end[j] - end[i]).squaredNorm();
            if (is_taut(squared, rest * rest) != left_out) continue;
            if (!left_out) {
                // On its line it pushes at the end with k_s times what it lacks there.
                const Vec3 d = x[j] - x[i];
                const double length = d.norm();
                if (is_taut(length, rest) || length == 0) continue;
                taut[s] = 2;
                const double longer = d.dot(end[j] - end[i]) / length - length;
                found[chunk].energy += std::max(0.0, stiffness * (rest - length - longer) * longer);
                continue;
            }
            const double of_spring = kappa_between(h, mass[i], mass[j], stiffness, springs.damping[s]);
            if (is_explicit(of_spring, splitting.threshold(s < springs.stretch_count))) continue;
            taut[s] = 1;
            const double length = std::sqrt(squared);
            found[chunk].energy += extension_energy(length, rest, stiffness);
            if (is_taut(length, (1 + strain) * rest)) found[chunk].missed = true;
        }
    });
    Misjudged all;
    for (const Misjudged& of : found) {
        all.missed = all.missed || of.missed;
        all.energy += of.energy;
    }
    return all;
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
