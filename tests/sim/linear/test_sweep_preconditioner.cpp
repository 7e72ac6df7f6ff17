// Sweeping preconditioners: constrained CG with them against a direct solve of the projected dense system,
// decomposed and whole.

#include <catch2/catch.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "sim/linear/solve.hpp"
#include "sim/scene/random.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

struct Problem {
    std::size_t n;
    ExtensionSprings springs;
    ExtensionForces forces;
    Adjacency adjacency;
    Constraints constraints;
    std::vector<double> mass;
    std::vector<Vec3> impulse, drift, guess;
    double h = 0.01;
    std::uint64_t seed, draw = 0;

    double uniform() { return seeded_uniform(static_cast<std::uint32_t>(seed), draw++); }  // [−1, 1)
    bool chance(double share) { return 0.5 * (uniform() + 1) < share; }
    Vec3 vector() {
        const double x = uniform(), y = uniform(), z = uniform();
        return {x, y, z};
    }

    Problem(std::size_t particles, double edges, double constrained, std::uint64_t s)
        : n(particles), seed(s) {
        for (std::uint32_t a = 0; a < n; ++a) {
            for (std::uint32_t b = a + 1; b < n; ++b) {
                if (!chance(edges)) continue;
                springs.i.push_back(a);
                springs.j.push_back(b);
                springs.stiffness.push_back(100 * (1.1 + uniform()));
                springs.damping.push_back(0.1 * (1 + uniform()));
                forces.direction.push_back(vector().normalized());
                forces.transverse.push_back(springs.stiffness.back() * 0.2 * (1 + uniform()));
                forces.state.push_back(chance(0.8) ? SpringState::implicit : SpringState::inactive);
            }
        }
        adjacency = adjacency_of(n, springs.i, springs.j);
        constraints.reset(n);
        for (std::uint32_t p = 0; p < n; ++p) {
            mass.push_back(1e-3 * (1.5 + uniform()));
            impulse.push_back(1e-3 * vector());
            drift.push_back(1e-2 * vector());
            guess.push_back(vector());
            if (chance(constrained)) constraints.add(constraint(p));
        }
    }

    Constraint constraint(std::uint32_t p) {
        Constraint c;
        c.particle = p;
        const Vec3 normal = vector().normalized(), z = vector();
        c.free = static_cast<std::uint8_t>(1.5 * (uniform() + 1));
        if (c.free == 1) c.S = normal * normal.transpose();
        if (c.free == 2) c.S = Mat3::Identity() - normal * normal.transpose();
        c.z = z - c.S * z;
        return c;
    }

    void assemble_for(const Components& components, System& A) const {
        const SpringFamily families[] = {{&springs, &adjacency, &forces}};
        assemble({families}, Load{mass, impulse, drift}, components, constraints, h, A);
    }

    // Sx = Sb, (I − S)x = (I − S)z by a factorisation of S A S + I − S. (particles)
    std::vector<Vec3> direct() const {
        Components whole;
        whole_cloth(n, whole);
        System A;
        assemble_for(whole, A);
        const auto size = static_cast<Eigen::Index>(3 * n);
        Eigen::MatrixXd dense(size, size), S = Eigen::MatrixXd::Identity(size, size);
        Eigen::VectorXd b(size), z = Eigen::VectorXd::Zero(size);
        for (Eigen::Index c = 0; c < size; ++c) {
            std::vector<Vec3> unit(n, Vec3::Zero());
            unit[static_cast<std::size_t>(c / 3)][c % 3] = 1;
            for (std::uint32_t r = 0; r < n; ++r) dense.block<3, 1>(3 * r, c) = row_times(A, r, unit);
        }
        for (std::uint32_t p = 0; p < n; ++p) {
            b.segment<3>(3 * p) = A.b[p];
            if (const Constraint* c = constraints.find(p)) {
                S.block<3, 3>(3 * p, 3 * p) = c->S;
                z.segment<3>(3 * p) = c->z;
            }
        }
        const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(size, size);
        const Eigen::VectorXd x = z + (S * dense * S + I - S).ldlt().solve(S * (b - dense * z));
        std::vector<Vec3> out;
        for (std::uint32_t p = 0; p < n; ++p) out.push_back(x.segment<3>(3 * p));
        return out;
    }

    std::vector<Vec3> iterative(Preconditioner kind, bool decompose,
                                std::uint64_t* iterations = nullptr) const {
        Components components;
        std::vector<std::uint32_t> scratch;
        const SpringFamily families[] = {{&springs, &adjacency, &forces}};
        if (decompose) {
            find_components(n, {families}, constraints, scratch, components);
        } else {
            whole_cloth(n, components);
        }
        System A;
        assemble_for(components, A);
        SolveWorkspace ws;
        std::vector<ComponentSolve> solves;
        solve(A, components, constraints, guess, {kind, 1e-12, 1000}, ws, solves);
        std::vector<Vec3> x(n);
        for (std::size_t row = 0; row < n; ++row) x[components.order[row]] = ws.x[row];
        for (const ComponentSolve& s : solves) {
            CHECK(s.converged);
            if (iterations) *iterations += s.iterations;
        }
        return x;
    }
};

constexpr Preconditioner kinds[] = {Preconditioner::ssor, Preconditioner::ic0};

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = 0;
    for (std::size_t p = 0; p < a.size(); ++p) largest = std::max(largest, (a[p] - b[p]).norm());
    return largest;
}

}  // namespace

// Velocities are of size one and the systems' condition below 10⁴: a residual of 1e-12 leaves 1e-8 at most.
TEST_CASE("constrained_cg_that_sweeps_matches_a_direct_solve") {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        const double edges[] = {0.05, 0.15, 0.6}, constrained[] = {0, 0.3, 0.8};
        const Problem p(20, edges[seed % 3], constrained[seed / 3 % 3], seed);
        const std::vector<Vec3> exact = p.direct();
        for (const Preconditioner kind : kinds) {
            for (const bool decompose : {true, false}) {
                INFO("seed " << seed << ", preconditioner " << static_cast<int>(kind) << ", decomposed "
                             << decompose);
                CHECK(largest_difference(p.iterative(kind, decompose), exact) < 1e-8);
            }
        }
    }
}

TEST_CASE("systems_of_no_rows_one_row_and_prescribed_rows_are_solved") {
    for (const Preconditioner kind : kinds) {
        const Problem none(0, 0, 0, 1);
        CHECK(none.iterative(kind, true).empty());
        const Problem single(1, 0, 0, 1);
        CHECK(largest_difference(single.iterative(kind, true), single.direct()) < 1e-12);
        Problem held(12, 0.5, 0, 1);
        for (std::uint32_t q = 0; q < held.n; ++q) held.constraints.add({q, 0, Mat3::Zero(), held.vector()});
        const std::vector<Vec3> x = held.iterative(kind, true);
        for (std::uint32_t q = 0; q < held.n; ++q) CHECK(x[q] == held.constraints.find(q)->z);
    }
}

TEST_CASE("preconditioners_that_sweep_need_fewer_iterations_than_the_block") {
    std::uint64_t block = 0, ssor = 0, ic0 = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Problem p(60, 0.08, 0.3, seed);
        p.iterative(Preconditioner::constrained_block, true, &block);
        p.iterative(Preconditioner::ssor, true, &ssor);
        p.iterative(Preconditioner::ic0, true, &ic0);
    }
    CHECK(ssor < 0.8 * static_cast<double>(block));
    CHECK(ic0 < 0.8 * static_cast<double>(block));
}
