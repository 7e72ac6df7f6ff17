#include "sim/linear/components.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace unravel::sim {

namespace {

constexpr std::uint32_t no_particle = 0xffffffffu;

// Root of p, halving the path on the way. A root is always its set's smallest particle.
std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t p) {
    while (parent[p] != p) {
        parent[p] = parent[parent[p]];
        p = parent[p];
    }
    return p;
}

}  // namespace

std::uint32_t Components::largest() const {
    std::uint32_t most = 0;
    for (std::size_t c = 0; c < count(); ++c) most = std::max(most, size(c));
    return most;
}

bool any_implicit(const Couplings& couplings) {
    const auto in_family = [](const SpringFamily& family) {
        const std::vector<SpringState>& state = family.forces->state;
        return std::find(state.begin(), state.end(), SpringState::implicit) != state.end();
    };
    const auto in_list = [](const Stencils& stencils) {
        bool any = false;
        for (std::size_t s = 0; s < stencils.list.size() && !any; ++s) any = stencils.is_implicit(s);
        return any;
    };
    return std::any_of(couplings.springs.begin(), couplings.springs.end(), in_family) ||
           std::any_of(couplings.stencils.begin(), couplings.stencils.end(), in_list);
}

void find_components(std::size_t particles, const Couplings& couplings, const Constraints& constraints,
                     std::vector<std::uint32_t>& parent, Components& out) {
    // label marks the fully constrained first: the search must not walk through them.
    out.label.assign(particles, 0);
    for (const Constraint& c : constraints.all()) {
        if (c.free == 0) out.label[c.particle] = -1;
    }
    parent.resize(particles);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto join = [&](std::uint32_t i, std::uint32_t j) {
        const std::uint32_t a = root_of(parent, i), b = root_of(parent, j);
        parent[std::max(a, b)] = std::min(a, b);
    };
    for (const SpringFamily& family : couplings.springs) {
        const std::vector<SpringState>& state = family.forces->state;
        for (std::size_t s = 0; s < state.size(); ++s) {
            if (state[s] != SpringState::implicit) continue;
            const std::uint32_t i = family.springs->i[s], j = family.springs->j[s];
            if (out.label[i] >= 0 && out.label[j] >= 0) join(i, j);
        }
    }
    for (const Stencils& stencils : couplings.stencils) {
        for (std::size_t s = 0; s < stencils.list.size(); ++s) {
            if (!stencils.is_implicit(s)) continue;
            const Stencil& stencil = stencils.list[s];
            std::uint32_t first = no_particle;
            for (std::uint32_t k = 0; k < stencil.count; ++k) {
                const std::uint32_t p = stencil.p[k];
                if (stencil.w[k] == 0 || out.label[p] < 0) continue;
                if (first == no_particle) {
                    first = p;
                } else {
                    join(first, p);
                }
            }
        }
    }
    // A root precedes its members, so one pass in particle order numbers components by their smallest
    // particle.
    out.start.clear();
    for (std::uint32_t p = 0; p < particles; ++p) {
        if (out.label[p] < 0) continue;
        const std::uint32_t root = root_of(parent, p);
        if (root == p) {
            out.label[p] = static_cast<std::int32_t>(out.start.size());
            out.start.push_back(1);
        } else {
            out.label[p] = out.label[root];
            ++out.start[static_cast<std::size_t>(out.label[root])];
        }
    }
    // Sizes become places, and particles are dealt to them in order: a bin sort.
    std::uint32_t place = 0;
    for (std::uint32_t& begin : out.start) place += std::exchange(begin, place);
    out.start.push_back(place);
    out.order.resize(particles);
    std::uint32_t constrained = place;
    for (std::uint32_t p = 0; p < particles; ++p) {
        const std::int32_t c = out.label[p];
        out.order[c < 0 ? constrained++ : out.start[static_cast<std::size_t>(c)]++] = p;
    }
    // Dealing moved every start to the next one's.
    for (std::size_t c = out.start.size() - 1; c > 0; --c) out.start[c] = out.start[c - 1];
    out.start[0] = 0;
}

void whole_cloth(std::size_t particles, Components& out) {
    out.label.assign(particles, 0);
    out.order.resize(particles);
    std::iota(out.order.begin(), out.order.end(), 0u);
    out.start = {0, static_cast<std::uint32_t>(particles)};
}

void lone_particles(std::size_t particles, const Constraints& constraints, Components& out) {
    out.label.assign(particles, 0);
    out.order.resize(particles);
    std::uint32_t lone = 0;
    for (const Constraint& c : constraints.all()) {
        if (c.free == 0) out.label[c.particle] = -1;
    }
    for (std::uint32_t p = 0; p < particles; ++p) {
        if (out.label[p] < 0) continue;
        out.label[p] = static_cast<std::int32_t>(lone);
        out.order[lone++] = p;
    }
    out.start.resize(lone + 1);
    std::iota(out.start.begin(), out.start.end(), 0u);
    for (std::uint32_t p = 0; p < particles; ++p) {
        if (out.label[p] < 0) out.order[lone++] = p;
    }
}

}  // namespace unravel::sim
