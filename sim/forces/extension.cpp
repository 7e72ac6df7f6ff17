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
        const double rest = springs.rest[s];
        const double stiffness = springs.stiffness[s], damping = springs.damping[s];
        const double lighter = std::min(mass[i], mass[j]);
        const double threshold =
            s < springs.stretch_count ? splitting.stretch_threshold : splitting.shear_threshold;
        const bool is_explicit = kappa(h, 1.0 / lighter, stiffness, damping) <= threshold;
        const Vec3 now = x[j] - x[i];
        const bool looks_ahead = !is_explicit && !ahead.empty();
        const Vec3 d = looks_ahead ? Vec3(ahead[j] - ahead[i]) : now;
        const double squared = d.squaredNorm();
        const bool will_be_taut = !taut.empty() && taut[s] != 0;
        const double reach = will_be_taut ? 0.0 : (1.0 - band) * rest;
        // What is taut now and slack ahead still resists: dropped, it would let the next step start
        // over-taut.
        const bool out_of_reach =
            squared <= reach * reach && !(looks_ahead && now.squaredNorm() > reach * reach);
        if (out_of_reach || squared == 0) {
            out.force[s].setZero();
            out.state[s] = SpringState::inactive;
            return;
        }
        const double length = std::sqrt(squared);
        if (length <= rest && is_explicit) {
            out.force[s].setZero();
            out.state[s] = SpringState::inactive;
            return;
        }
        const Vec3 u = d / length;
        // Damping acts along the spring at x: its Jacobian knows how it changes with velocity, not with the
        // spring's turning, so that taken elsewhere it would cost a second-order scheme its order.
        const Vec3 turned = looks_ahead && now.squaredNorm() > 0 ? Vec3(now.normalized()) : u;
        const double slowed = damping * turned.dot(v[j] - v[i]);
        out.direction[s] = u;
        out.state[s] = is_explicit ? SpringState::explicit_ : SpringState::implicit;
        if (length > rest) {
            out.force[s] = stiffness * (length - rest) * u + slowed * turned;
            out.transverse[s] = stiffness * (1.0 - rest / length);
        } else if (will_be_taut) {
            out.force[s] = stiffness * (length - rest) * u + slowed * turned;
            out.transverse[s] = 0;
        } else {
            out.force[s].setZero();
            out.transverse[s] = 0;
        }
    });
}

bool mark_taut(const ExtensionSprings& springs, std::span<const Vec3> end, const ExtensionForces& forces,
               std::vector<std::uint8_t>& taut) {
    taut.resize(springs.size(), 0);
    std::vector<std::uint8_t> found(chunk_count(springs.size()), 0);
    parallel_chunks(springs.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            if (taut[s] || (!forces.state.empty() && forces.state[s] != SpringState::inactive)) continue;
            const double rest = springs.rest[s];
            if ((end[springs.j[s]] - end[springs.i[s]]).squaredNorm() <= rest * rest) continue;
            taut[s] = found[chunk] = 1;
        }
    });
    return std::find(found.begin(), found.end(), 1) != found.end();
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
