// The graph search against a naive traversal.

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "sim/linear/components.hpp"
#include "sim/scene/random.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

struct Graph {
    std::size_t n;
    ExtensionSprings springs;
    ExtensionForces forces;
    Adjacency adjacency;
    Constraints constraints;

    Graph(std::size_t particles, double edge_share, double implicit_share, double constrained_share,
          std::uint64_t seed)
        : n(particles) {
        std::uint64_t draw = 0;
        const auto below = [&](double share) { return 0.5 * (seeded_uniform(seed, draw++) + 1) < share; };
        for (std::uint32_t a = 0; a < n; ++a) {
            for (std::uint32_t b = a + 1; b < n; ++b) {
                if (!below(edge_share)) continue;
                springs.i.push_back(a);
                springs.j.push_back(b);
                forces.state.push_back(below(implicit_share) ? SpringState::implicit
                                       : below(0.5)          ? SpringState::explicit_
                                                             : SpringState::inactive);
            }
        }
        constraints.reset(n);
        for (std::uint32_t p = 0; p < n; ++p) {
            if (below(constrained_share)) {
                constraints.add({p, 0, Mat3::Zero(), Vec3::Zero()});
            } else if (below(0.3)) {
                constraints.add({p, 2, Mat3::Identity(), Vec3::Zero()});
            }
        }
        adjacency = adjacency_of(n, springs.i, springs.j);
    }

    Components find() const {
        Components out;
        std::vector<std::uint32_t> scratch;
        const SpringFamily families[] = {{&springs, &adjacency, &forces}};
        find_components(n, {families}, constraints, scratch, out);
        return out;
    }

    // Spread labels until nothing changes: slow and obviously right.
    std::vector<std::int32_t> naive() const {
        std::vector<std::int32_t> label(n);
        for (std::uint32_t p = 0; p < n; ++p)
            label[p] = constraints.fully(p) ? -1 : static_cast<std::int32_t>(p);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t s = 0; s < springs.size(); ++s) {
                std::int32_t &a = label[springs.i[s]], &b = label[springs.j[s]];
                if (forces.state[s] != SpringState::implicit || a < 0 || b < 0 || a == b) continue;
                a = b = std::min(a, b);
                changed = true;
            }
        }
        // Ids in the order of their smallest particle.
        std::set<std::int32_t> roots(label.begin(), label.end());
        roots.erase(-1);
        const std::vector<std::int32_t> order(roots.begin(), roots.end());
        for (std::int32_t& l : label) {
            if (l >= 0)
                l = static_cast<std::int32_t>(std::lower_bound(order.begin(), order.end(), l) -
                                              order.begin());
        }
        return label;
    }
};

void check_order(const Components& c, std::size_t n) {
    REQUIRE(c.order.size() == n);
    std::set<std::uint32_t> seen(c.order.begin(), c.order.end());
    CHECK(seen.size() == n);
    for (std::size_t k = 0; k < c.count(); ++k) {
        CHECK(c.size(k) > 0);
        for (std::uint32_t at = c.start[k]; at < c.start[k + 1]; ++at) {
            CHECK(c.label[c.order[at]] == static_cast<std::int32_t>(k));
            if (at > c.start[k]) CHECK(c.order[at - 1] < c.order[at]);
        }
    }
    for (std::size_t at = c.start.back(); at < n; ++at) CHECK(c.label[c.order[at]] == -1);
}

}  // namespace

TEST_CASE("components match a naive traversal on random graphs") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const double density = 0.15 * (seeded_uniform(seed, 1000000) + 1);
        const Graph graph(1 + seed % 40, density, 0.5, 0.2, seed);
        const Components found = graph.find();
        REQUIRE(found.label == graph.naive());
        check_order(found, graph.n);
    }
}

TEST_CASE("without implicit springs every free particle is alone, with all of them connected all are one") {
    const Graph apart(30, 1.0, 0.0, 0.1, 7), together(30, 1.0, 1.0, 0.0, 7);
    const Components alone = apart.find(), one = together.find();
    for (std::size_t c = 0; c < alone.count(); ++c) CHECK(alone.size(c) == 1);
    CHECK(alone.largest() == 1);
    CHECK(one.count() == 1);
    CHECK(one.largest() == 30);
}

TEST_CASE("fully constrained particles cut a chain, partly constrained ones do not") {
    Graph chain(5, 0, 0, 0, 1);
    chain.springs.i = {0, 1, 2, 3};
    chain.springs.j = {1, 2, 3, 4};
    chain.forces.state.assign(4, SpringState::implicit);
    chain.adjacency = adjacency_of(5, chain.springs.i, chain.springs.j);
    chain.constraints.reset(5);
    chain.constraints.add({2, 0, Mat3::Zero(), Vec3::Zero()});
    CHECK(chain.find().label == std::vector<std::int32_t>{0, 0, -1, 1, 1});
    chain.constraints.reset(5);
    chain.constraints.add({2, 1, Mat3::Identity(), Vec3::Zero()});
    CHECK(chain.find().count() == 1);
}

TEST_CASE("all particles constrained leave no component") {
    const Graph graph(10, 1.0, 1.0, 1.0, 3);
    const Components found = graph.find();
    CHECK(found.count() == 0);
    CHECK(found.largest() == 0);
    check_order(found, 10);
}
