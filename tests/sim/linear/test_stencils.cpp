// Stencils of one to four particles in the linear system, beside springs: against what they are defined to
// be, and through every preconditioner.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "sim/linear/aggregation.hpp"
#include "sim/linear/solve.hpp"
#include "sim/scene/random.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// Particles with random springs, stencils and constraints.
struct Problem {
    std::size_t n;
    ExtensionSprings springs;
    ExtensionForces forces;
    Adjacency adjacency;
    // Contacts of one to four particles, all implicit, made elsewhere than the springs; and bends, some of
    // them explicit.
    std::vector<Stencil> contacts, bends;
    std::vector<SpringState> bend_state;
    Constraints constraints;
    std::vector<double> mass;
    std::vector<Vec3> impulse, drift, drift_of_contacts, guess;
    std::uint64_t seed, draw = 0;
    static constexpr double h = 0.01;

    double uniform() { return seeded_uniform(seed, draw++); }
    double positive() { return 0.5 * (uniform() + 1.0) + 1e-3; }
    Vec3 vector() {
        const double x = uniform(), y = uniform(), z = uniform();
        return {x, y, z};
    }
    std::uint32_t particle() {
        return std::min(static_cast<std::uint32_t>(0.5 * (uniform() + 1) * static_cast<double>(n)),
                        static_cast<std::uint32_t>(n - 1));
    }
    Stencil stencil(std::uint32_t count) {
        Stencil s;
        s.count = count;
        for (std::uint32_t k = 0; k < count; ++k) {
            do s.p[k] = particle();
            while (std::find(s.p.begin(), s.p.begin() + k, s.p[k]) != s.p.begin() + k);
            s.w[k] = uniform();
        }
        s.u = vector().normalized();
        return s;
    }

    Problem(std::size_t particles, double edges, std::size_t stencils, double full, double partly,
            std::uint64_t s)
        : n(particles), seed(s) {
        for (std::uint32_t a = 0; a < n; ++a) {
            mass.push_back(0.01 * (0.5 + positive()));
            impulse.push_back(0.1 * vector());
            drift.push_back(0.01 * vector());
            drift_of_contacts.push_back(0.01 * vector());
            guess.push_back(vector());
            for (std::uint32_t b = a + 1; b < n; ++b) {
                if (positive() > edges) continue;
                springs.add(a, b, 1.0, 100 * positive(), 0.1 * positive());
                forces.direction.push_back(vector().normalized());
                forces.transverse.push_back(springs.stiffness.back() * 0.3 * positive());
                forces.state.push_back(SpringState::implicit);
            }
        }
        adjacency = adjacency_of(n, springs.i, springs.j);
        for (std::size_t k = 0; k < stencils; ++k) {
            Stencil c = stencil(1 + static_cast<std::uint32_t>(k % std::min<std::size_t>(4, n)));
            c.along = 200 * positive();
            c.damping_along = 0.5 * positive();
            c.damping_across = k % 2 ? 0.5 * positive() : 0.0;
            if (k % 7 == 3) c.w[1] = 0;
            contacts.push_back(c);
            if (n < 3) continue;
            Stencil bend = stencil(3);
            bend.w = {1, -2, 1, 0};
            bend.along = bend.across = 40 * positive();
            bends.push_back(bend);
            bend_state.push_back(positive() < 0.6 ? SpringState::implicit : SpringState::explicit_);
        }
        constraints.reset(n);
        for (std::uint32_t p = 0; p < n; ++p) {
            const double pick = positive();
            if (pick > full + partly) continue;
            const Vec3 normal = vector().normalized(), z = vector();
            const Mat3 across = Mat3::Identity() - normal * normal.transpose();
            if (pick < full) {
                constraints.add({p, 0, Mat3::Zero(), z});
            } else if (positive() < 0.5) {
                constraints.add({p, 2, across, z});
            } else {
                const Vec3 other = (across * vector()).normalized();
                constraints.add({p, 1, across - other * other.transpose(), z});
            }
        }
    }

    // Calls f with what the solver takes.
    template <typename F>
    void with(const F& f) const {
        const SpringFamily family[] = {{&springs, &adjacency, &forces}};
        const Stencils lists[] = {{contacts, {}, drift_of_contacts}, {bends, bend_state}};
        f(Couplings{family, lists});
    }
    Components decomposed() const {
        Components out;
        std::vector<std::uint32_t> scratch;
        with([&](const Couplings& all) { find_components(n, all, constraints, scratch, out); });
        return out;
    }
    Components whole() const {
        Components out;
        whole_cloth(n, out);
        return out;
    }
    System assembled(const Components& components) const {
        System A;
        with([&](const Couplings& all) {
            assemble(all, {mass, impulse, drift}, components, constraints, h, A);
        });
        return A;
    }
    std::vector<Vec3> solved(const Components& components, const SolveOptions& options,
                             std::vector<ComponentSolve>& solves) const {
        const System A = assembled(components);
        SolveWorkspace ws;
        solve(A, components, constraints, guess, options, ws, solves);
        std::vector<Vec3> x(n);
        for (std::size_t row = 0; row < n; ++row) x[components.order[row]] = ws.x[row];
        return x;
    }

    // f of all implicit stencils for displacements and velocities from where they were made, by their
    // definition.
    std::vector<Vec3> stencil_forces(const std::vector<Vec3>& dx_contacts, const std::vector<Vec3>& dx_bends,
                                     const std::vector<Vec3>& dv) const {
        std::vector<Vec3> f(n, Vec3::Zero());
        const auto add = [&](const Stencil& s, const std::vector<Vec3>& dx) {
            const Mat3 uu = s.u * s.u.transpose(), rest = Mat3::Identity() - uu;
            const Mat3 K = s.along * uu + s.across * rest;
            const Mat3 D = s.damping_along * uu + s.damping_across * rest;
            Vec3 y = Vec3::Zero(), y_dot = Vec3::Zero();
            for (std::uint32_t k = 0; k < s.count; ++k) {
                y += s.w[k] * dx[s.p[k]];
                y_dot += s.w[k] * dv[s.p[k]];
            }
            for (std::uint32_t k = 0; k < s.count; ++k) f[s.p[k]] -= s.w[k] * (K * y + D * y_dot);
        };
        for (const Stencil& s : contacts) add(s, dx_contacts);
        for (std::size_t k = 0; k < bends.size(); ++k)
            if (bend_state[k] == SpringState::implicit) add(bends[k], dx_bends);
        return f;
    }
    // f of the springs, likewise.
    std::vector<Vec3> spring_forces(const std::vector<Vec3>& dx, const std::vector<Vec3>& dv) const {
        std::vector<Vec3> f(n, Vec3::Zero());
        for (std::size_t s = 0; s < springs.size(); ++s) {
            const std::uint32_t i = springs.i[s], j = springs.j[s];
            const Vec3 u = forces.direction[s], d = dx[j] - dx[i];
            const double t = forces.transverse[s], k = springs.stiffness[s];
            const Vec3 on_i = t * d + ((k - t) * u.dot(d) + springs.damping[s] * u.dot(dv[j] - dv[i])) * u;
            f[i] += on_i;
            f[j] -= on_i;
        }
        return f;
    }
    // M Δv − h f, f what changes with Δv: A Δv.
    std::vector<Vec3> times(const std::vector<Vec3>& dv) const {
        std::vector<Vec3> dx(n);
        for (std::size_t p = 0; p < n; ++p) dx[p] = h * dv[p];
        const std::vector<Vec3> stencil = stencil_forces(dx, dx, dv), spring = spring_forces(dx, dv);
        std::vector<Vec3> out(n);
        for (std::size_t p = 0; p < n; ++p) out[p] = mass[p] * dv[p] - h * (stencil[p] + spring[p]);
        return out;
    }
    std::vector<Vec3> right_side() const {
        const std::vector<Vec3> still(n, Vec3::Zero());
        const std::vector<Vec3> stencil = stencil_forces(drift_of_contacts, drift, still),
                                spring = spring_forces(drift, still);
        std::vector<Vec3> out(n);
        for (std::size_t p = 0; p < n; ++p) out[p] = impulse[p] + h * (stencil[p] + spring[p]);
        return out;
    }
    Eigen::MatrixXd dense() const {
        const auto size = static_cast<Eigen::Index>(3 * n);
        Eigen::MatrixXd A(size, size);
        for (Eigen::Index c = 0; c < size; ++c) {
            std::vector<Vec3> unit(n, Vec3::Zero());
            unit[static_cast<std::size_t>(c / 3)][c % 3] = 1;
            const std::vector<Vec3> column = times(unit);
            for (std::uint32_t p = 0; p < n; ++p) A.block<3, 1>(3 * p, c) = column[p];
        }
        return A;
    }
    // Sx = Sb, (I − S)x = (I − S)z by a factorisation of S A S + I − S.
    std::vector<Vec3> direct() const {
        const Eigen::MatrixXd A = dense();
        const std::vector<Vec3> right = right_side();
        Eigen::MatrixXd S = Eigen::MatrixXd::Identity(A.rows(), A.rows());
        Eigen::VectorXd b(A.rows()), z = Eigen::VectorXd::Zero(A.rows());
        for (std::uint32_t p = 0; p < n; ++p) {
            b.segment<3>(3 * p) = right[p];
            if (const Constraint* c = constraints.find(p)) {
                S.block<3, 3>(3 * p, 3 * p) = c->S;
                z.segment<3>(3 * p) = c->z - c->S * c->z;
            }
        }
        const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(A.rows(), A.rows());
        const Eigen::VectorXd x = z + (S * A * S + I - S).ldlt().solve(S * (b - A * z));
        std::vector<Vec3> out;
        for (std::uint32_t p = 0; p < n; ++p) out.push_back(x.segment<3>(3 * p));
        return out;
    }
};

double most_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double most = 0;
    for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, (a[p] - b[p]).norm());
    return most;
}

constexpr Preconditioner all_kinds[] = {Preconditioner::none,  Preconditioner::diagonal,
                                        Preconditioner::block, Preconditioner::constrained_block,
                                        Preconditioner::ssor,  Preconditioner::ic0};

}  // namespace

TEST_CASE(
    "stencils and springs assemble to what their forces are defined to be, constraint forces included") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Problem problem(4 + 2 * seed, 0.2, 5 + seed, 0.2, 0.3, seed);
        for (const bool decompose : {true, false}) {
            const Components components = decompose ? problem.decomposed() : problem.whole();
            const System A = problem.assembled(components);
            REQUIRE(!A.blocks.empty());
            // Any Δv at all, but that particles which are not solved for move as they are told.
            std::vector<Vec3> dv(problem.n), by_row(problem.n);
            for (std::uint32_t p = 0; p < problem.n; ++p) {
                dv[p] = problem.vector();
                const Constraint* c = problem.constraints.find(p);
                if (decompose && c && c->free == 0) dv[p] = c->z;
                by_row[A.row_of[p]] = dv[p];
            }
            const std::vector<Vec3> product = problem.times(dv), right = problem.right_side();
            for (std::uint32_t p = 0; p < problem.n; ++p) {
                INFO("seed " << seed << ", decomposed " << decompose << ", particle " << p);
                const std::uint32_t row = A.row_of[p];
                // Terms are of the order of one; sums of some tens of them round by 1e-15 of that each.
                CHECK((row_times(A, row, by_row) - A.b[row] - (product[p] - right[p])).norm() < 1e-13);
            }
        }
    }
}

TEST_CASE(
    "with stencils A is symmetric positive definite, its least eigenvalue no less than the lightest mass") {
    const Problem problem(14, 0.2, 25, 0, 0, 5);
    const System A = problem.assembled(problem.whole());
    Eigen::MatrixXd full(42, 42);
    for (Eigen::Index c = 0; c < 42; ++c) {
        std::vector<Vec3> unit(14, Vec3::Zero());
        unit[static_cast<std::size_t>(c / 3)][c % 3] = 1;
        for (std::uint32_t row = 0; row < 14; ++row) full.block<3, 1>(3 * row, c) = row_times(A, row, unit);
    }
    CHECK((full - full.transpose()).norm() < 1e-14 * full.norm());
    const double lightest = *std::min_element(problem.mass.begin(), problem.mass.end());
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues().minCoeff() >=
          lightest * (1 - 1e-9));
}

TEST_CASE("components follow implicit stencils, but not through weights of zero or held particles") {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const Problem problem(5 + seed % 20, 0.02, 1 + seed % 5, 0.2, 0.2, seed);
        std::vector<std::uint32_t> label(problem.n);
        for (std::uint32_t p = 0; p < problem.n; ++p) label[p] = p;
        const auto free = [&](std::uint32_t p) { return !problem.constraints.fully(p); };
        // Spread labels until nothing changes: slow and obviously right.
        for (bool changed = true; changed;) {
            changed = false;
            const auto join = [&](std::uint32_t p, std::uint32_t q) {
                if (!free(p) || !free(q) || label[p] == label[q]) return;
                label[p] = label[q] = std::min(label[p], label[q]);
                changed = true;
            };
            const auto join_all = [&](const Stencil& s) {
                for (std::uint32_t k = 0; k < s.count; ++k)
                    for (std::uint32_t l = 0; l < k; ++l)
                        if (s.w[k] != 0 && s.w[l] != 0) join(s.p[k], s.p[l]);
            };
            for (std::size_t s = 0; s < problem.springs.size(); ++s)
                join(problem.springs.i[s], problem.springs.j[s]);
            for (const Stencil& s : problem.contacts) join_all(s);
            for (std::size_t s = 0; s < problem.bends.size(); ++s)
                if (problem.bend_state[s] == SpringState::implicit) join_all(problem.bends[s]);
        }
        const Components found = problem.decomposed();
        for (std::uint32_t p = 0; p < problem.n; ++p) {
            REQUIRE((found.label[p] < 0) == !free(p));
            for (std::uint32_t q = 0; q < p; ++q) {
                if (free(p) && free(q)) REQUIRE((found.label[p] == found.label[q]) == (label[p] == label[q]));
            }
        }
    }
}

TEST_CASE("with stencils every preconditioner solves what a factorisation solves, decomposed and whole") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Problem problem(10 + 2 * seed, 0.05, 4 + seed, 0.15, 0.3, seed);
        const std::vector<Vec3> exact = problem.direct();
        for (const Preconditioner kind : all_kinds) {
            for (const bool decompose : {true, false}) {
                std::vector<ComponentSolve> solves;
                const std::vector<Vec3> x = problem.solved(decompose ? problem.decomposed() : problem.whole(),
                                                           {kind, 1e-11, 5000}, solves);
                INFO("seed " << seed << ", preconditioner " << static_cast<int>(kind) << ", decomposed "
                             << decompose);
                for (const ComponentSolve& s : solves) CHECK(s.converged);
                // Velocities are of order ten, condition numbers stay below 1e4.
                CHECK(most_apart(x, exact) < 1e-6);
            }
        }
    }
}

TEST_CASE("a particle that only drags on a solid is solved at once") {
    Problem problem(1, 0, 0, 0, 0, 3);
    Stencil drag;
    drag.count = 1;
    drag.w[0] = 1;
    drag.damping_across = 0.7;
    problem.contacts.push_back(drag);
    std::vector<ComponentSolve> solves;
    const std::vector<Vec3> x = problem.solved(problem.decomposed(), {}, solves);
    const double along = problem.mass[0], across = problem.mass[0] + Problem::h * 0.7;
    const Vec3 b = problem.impulse[0];
    CHECK((x[0] - Vec3(b.x() / across, b.y() / across, b.z() / along)).norm() < 1e-13);
    CHECK(solves.front().iterations == 1);
}

TEST_CASE("stencils that are all explicit change no bit") {
    Problem with(30, 0.1, 0, 0.1, 0.2, 4), without = with;
    with.bends.assign(3, with.stencil(4));
    with.bend_state.assign(3, SpringState::explicit_);
    std::vector<ComponentSolve> solves;
    const std::vector<Vec3> x = with.solved(with.decomposed(), {}, solves),
                            y = without.solved(without.decomposed(), {}, solves);
    CHECK(std::memcmp(x.data(), y.data(), x.size() * sizeof(Vec3)) == 0);
    CHECK(with.assembled(with.decomposed()).block_start.empty());
}

TEST_CASE("a system with stencils has the same solution to the bit for any number of threads") {
    const Problem problem(2500, 2e-4, 3000, 0.02, 0.1, 8);
    for (const Preconditioner kind : all_kinds) {
        std::vector<Vec3> first;
        for (const int threads : {1, 2, 5}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(threads));
            tbb::task_arena arena(threads);
            std::vector<Vec3> x;
            std::vector<ComponentSolve> solves;
            arena.execute([&] { x = problem.solved(problem.decomposed(), {kind, 1e-4, 300}, solves); });
            if (first.empty()) first = x;
            CHECK(std::memcmp(first.data(), x.data(), x.size() * sizeof(Vec3)) == 0);
        }
    }
}
