#pragma once

// Cloth that is no grid: numbered at random, braced by single diagonals, some springs slack, some particles
// held.

#include <Eigen/Geometry>
#include <numeric>
#include <vector>

#include "sim/linear/aggregation.hpp"
#include "sim/scene/random.hpp"
#include "sim/step/solve_components.hpp"

namespace unravel::testing {

using namespace sim;

enum Held : unsigned { nothing = 0, corners = 1, contacts = 2 };

struct Mesh {
    ExtensionSprings springs;
    Adjacency adjacency;
    ExtensionForces forces;
    Constraints constraints;
    Components components;
    std::vector<Stencil> stencils;
    std::vector<double> mass;
    std::vector<Vec3> impulse, drift, guess, at;
    std::uint64_t draw = 0;
    static constexpr double h = 0.005;

    double uniform() { return seeded_uniform(11, draw++); }
    Vec3 vector() { return {uniform(), uniform(), uniform()}; }

    // A square metre of n × n vertices.
    Mesh(int n, unsigned held, double stretch, double slack = 0.0, bool whole = false) {
        const auto count = static_cast<std::uint32_t>(n * n);
        std::vector<std::uint32_t> id(count);
        std::iota(id.begin(), id.end(), 0u);
        for (std::uint32_t k = count - 1; k > 0; --k)
            std::swap(id[k], id[static_cast<std::uint32_t>(0.5 * (1 + uniform()) * k)]);
        const double d = 1.0 / (n - 1);
        at.resize(count);
        mass.resize(count);
        const auto vertex = [&](int i, int j) { return id[static_cast<std::size_t>(j * n + i)]; };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                at[vertex(i, j)] = Vec3(i * d, 0, j * d) + 0.2 * d * vector();
                mass[vertex(i, j)] = 0.2 * d * d * (1 + 0.3 * uniform());
            }
        }
        const auto add = [&](std::uint32_t a, std::uint32_t b, double k) {
            springs.add(a, b, 0.98 * (at[a] - at[b]).norm(), k * (1 + 0.3 * uniform()), 1e-4);
        };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                if (i + 1 < n) add(vertex(i, j), vertex(i + 1, j), stretch);
                if (j + 1 < n) add(vertex(i, j), vertex(i, j + 1), stretch);
                if (i + 1 == n || j + 1 == n) continue;
                if (uniform() > 0) {
                    add(vertex(i, j), vertex(i + 1, j + 1), 0.3 * stretch);
                } else {
                    add(vertex(i + 1, j), vertex(i, j + 1), 0.3 * stretch);
                }
            }
        }
        adjacency = adjacency_of(count, springs.i, springs.j);
        forces.state.resize(springs.size());
        for (SpringState& state : forces.state)
            state = 0.5 * (1 + uniform()) < slack ? SpringState::inactive : SpringState::implicit;
        for (std::uint32_t p = 0; p < count; ++p) {
            impulse.push_back(mass[p] * (Vec3(0, -9.81 * h, 0) + 0.1 * vector()));
            drift.push_back(1e-4 * vector());
            guess.push_back(0.05 * vector());
        }
        constraints.reset(count);
        for (std::uint32_t p = 0; p < count; ++p) {
            const double pick = 0.5 * (1 + uniform());
            const Vec3& x = at[p];
            if ((held & corners) && x.z() < 0.07 && std::abs(x.x() - 0.5) > 0.43) {
                constraints.add({p, 0, Mat3::Zero(), 0.1 * vector()});
            } else if ((held & contacts) && x.z() > 0.4 && pick < 0.6) {
                const Vec3 normal = (Vec3(0, 1, 0) + 0.3 * vector()).normalized();
                const Mat3 two = Mat3::Identity() - normal * normal.transpose();
                const Vec3 other = normal.unitOrthogonal();
                if (pick < 0.2) {
                    constraints.add({p, 0, Mat3::Zero(), 0.01 * vector()});
                } else if (pick < 0.4) {
                    constraints.add({p, 2, two, 0.01 * normal});
                } else {
                    constraints.add({p, 1, two - other * other.transpose(), 0.01 * normal});
                }
            }
        }
        find(whole);
    }
    void find(bool whole) {
        std::vector<std::uint32_t> scratch;
        if (whole) return whole_cloth(mass.size(), components);
        const std::vector<SpringFamily> springs_of = families();
        const Stencils lists[] = {{stencils}};
        find_components(mass.size(), {springs_of, lists}, constraints, scratch, components);
    }
    // Bends of three vertices that springs join, and vertices that touch faces somewhere else, rubbing.
    void couple(double bend, double contact, bool whole) {
        for (std::uint32_t p = 0; p < mass.size(); ++p) {
            std::vector<std::uint32_t> near;
            adjacency.each(p, [&](std::uint32_t, std::uint32_t other) { near.push_back(other); });
            for (std::size_t k = 1; k < near.size(); k += 2) {
                Stencil s;
                s.count = 3;
                s.p = {near[k - 1], p, near[k]};
                s.w = {1, -2, 1};
                s.along = s.across = bend;
                stencils.push_back(s);
            }
            const auto far = static_cast<std::uint32_t>(0.4999 * (1 + uniform()) * double(mass.size()));
            if (near.size() < 2 || p % 5 != 0) continue;
            if (far == p || far == near[0] || far == near[1]) continue;
            Stencil s;
            s.count = 4;
            s.p = {far, p, near[0], near[1]};
            s.w = {1, -0.5, -0.2, -0.3};
            s.u = vector().normalized();
            s.along = contact;
            s.damping_across = 1e-3;
            stencils.push_back(s);
        }
        find(whole);
    }
    std::vector<SpringFamily> families() const { return {{&springs, &adjacency, &forces, {}, at}}; }
    Load load() const { return {mass, impulse, drift}; }
    std::size_t largest() const {
        std::size_t c = 0;
        for (std::size_t k = 1; k < components.count(); ++k)
            c = components.size(k) > components.size(c) ? k : c;
        return c;
    }
    System system() const {
        System A;
        const Stencils lists[] = {{stencils}};
        assemble({families(), lists}, load(), components, constraints, h, A);
        return A;
    }
    std::vector<const Constraint*> by_row() const {
        std::vector<const Constraint*> out;
        for (const std::uint32_t p : components.order) out.push_back(constraints.find(p));
        return out;
    }
};

// The solver as steps use it; keeps its memory.

}  // namespace unravel::testing
