// Constrained CG against direct solves, decomposed against whole.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "sim/linear/solve.hpp"
#include "sim/scene/random.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// A random spring network with random constraints, and its system.
struct Problem {
    std::size_t n;
    ExtensionSprings springs;
    ExtensionForces forces;
    Adjacency adjacency;
    Constraints constraints;
    std::vector<double> mass;
    std::vector<Vec3> impulse, drift, guess;
    std::uint64_t seed, draw = 0;
    double h = 0.01;

    double uniform() { return seeded_uniform(seed, draw++); }
    double positive() { return 0.5 * (uniform() + 1.0) + 1e-3; }
    Vec3 vector() { return {uniform(), uniform(), uniform()}; }

    Problem(std::size_t particles, double edges, double full, double partly, std::uint64_t s)
        : n(particles), seed(s) {
        for (std::uint32_t a = 0; a < n; ++a) {
            mass.push_back(0.01 * (0.5 + positive()));
            impulse.push_back(0.1 * vector());
            drift.push_back(0.01 * vector());
            guess.push_back(vector());
            for (std::uint32_t b = a + 1; b < n; ++b) {
                if (positive() > edges) continue;
                springs.i.push_back(a);
                springs.j.push_back(b);
                springs.stiffness.push_back(100 * positive());
                springs.damping.push_back(0.1 * positive());
                forces.direction.push_back(vector().normalized());
                forces.transverse.push_back(springs.stiffness.back() * 0.3 * positive());
                forces.state.push_back(SpringState::implicit);
            }
        }
        adjacency = adjacency_of(n, springs.i, springs.j);
        constraints.reset(n);
        for (std::uint32_t p = 0; p < n; ++p) {
            const double pick = positive();
            if (pick < full) {
                constraints.add({p, 0, Mat3::Zero(), vector()});
            } else if (pick < full + partly) {
                const Vec3 normal = vector().normalized();
                const Mat3 across = Mat3::Identity() - normal * normal.transpose();
                const bool two = positive() < 0.5;
                const Vec3 other = (across * vector()).normalized();
                const Mat3 S = two ? Mat3(across) : Mat3(across - other * other.transpose());
                constraints.add({p, static_cast<std::uint8_t>(two ? 2 : 1), S, vector()});
            }
        }
    }

    std::vector<SpringFamily> families() const { return {{&springs, &adjacency, &forces}}; }
    Components decomposed() const {
        Components components;
        std::vector<std::uint32_t> scratch;
        find_components(n, {families()}, constraints, scratch, components);
        return components;
    }
    Components whole() const {
        Components components;
        whole_cloth(n, components);
        return components;
    }
    System assembled(const Components& components) const {
        System system;
        assemble({families()}, {mass, impulse, drift}, components, constraints, h, system);
        return system;
    }
    std::vector<Vec3> solved(const Components& components, Preconditioner kind, double tolerance,
                             std::vector<ComponentSolve>& solves) const {
        const System system = assembled(components);
        SolveWorkspace ws;
        solve(system, components, constraints, guess, {kind, tolerance, 5000}, ws, solves);
        std::vector<Vec3> x(n);
        for (std::size_t row = 0; row < n; ++row) x[components.order[row]] = ws.x[row];
        return x;
    }

    // (SA + I − S) x = Sb + (I − S) z, Eq. (10), as a dense system. A and b of the undecomposed assembly.
    std::vector<Vec3> direct() const {
        const System system = assembled(whole());
        const auto size = static_cast<Eigen::Index>(3 * n);
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size), S = Eigen::MatrixXd::Identity(size, size);
        Eigen::VectorXd b(size), z = Eigen::VectorXd::Zero(size);
        for (std::uint32_t row = 0; row < n; ++row) {
            const Eigen::Index r = 3 * row;
            A.block<3, 3>(r, r) = system.diagonal[row];
            b.segment<3>(r) = system.b[row];
            for (std::uint32_t e = system.start[row]; e < system.start[row + 1]; ++e) {
                const System::Entry& entry = system.entries[e];
                A.block<3, 3>(r, 3 * entry.column) -=
                    entry.a * Mat3::Identity() + entry.w * entry.w.transpose();
            }
            if (const Constraint* c = constraints.find(row)) {
                S.block<3, 3>(r, r) = c->S;
                z.segment<3>(r) = c->z;
            }
        }
        REQUIRE((A - A.transpose()).norm() < 1e-12 * A.norm());
        const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(size, size);
        const Eigen::VectorXd x = (S * A + I - S).colPivHouseholderQr().solve(S * b + (I - S) * z);
        std::vector<Vec3> result(n);
        for (std::size_t p = 0; p < n; ++p) result[p] = x.segment<3>(static_cast<Eigen::Index>(3 * p));
        return result;
    }
};

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double most = 0;
    for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, (a[p] - b[p]).norm());
    return most;
}

constexpr Preconditioner block_kinds[] = {Preconditioner::none, Preconditioner::diagonal,
                                          Preconditioner::block, Preconditioner::constrained_block};

}  // namespace

TEST_CASE("constrained CG matches a direct solve of the projected system, for every block preconditioner") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Problem problem(5 + seed, 0.3, 0.15, 0.4, seed);
        const std::vector<Vec3> exact = problem.direct();
        for (const Preconditioner kind : block_kinds) {
            std::vector<ComponentSolve> solves;
            const std::vector<Vec3> x = problem.solved(problem.decomposed(), kind, 1e-11, solves);
            for (const ComponentSolve& s : solves) CHECK(s.converged);
            // Velocities are of order ten, condition numbers stay below 1e4.
            CHECK(difference(x, exact) < 1e-6);
        }
    }
}

// ‖S(b − A x)‖ / ‖Sb‖ in the norm of the projected diagonal blocks' pseudo-inverses, from Eq. (9) as it
// stands.
TEST_CASE("every preconditioner stops at the first iterate whose residual one measure finds small enough") {
    constexpr double tolerance = 1e-4;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Problem problem(80, 0.06, 0.1, 0.4, seed);
        const Components whole = problem.whole();
        const System system = problem.assembled(whole);
        const auto stopped = [&](Preconditioner kind, int most, ComponentSolve& solve_took) {
            SolveWorkspace ws;
            std::vector<ComponentSolve> solves;
            solve(system, whole, problem.constraints, problem.guess, {kind, tolerance, most}, ws, solves);
            solve_took = solves.front();
            double residual = 0, right = 0;
            for (std::uint32_t row = 0; row < problem.n; ++row) {
                const Constraint* c = problem.constraints.find(row);
                const Mat3 S = c ? c->S : Mat3(Mat3::Identity());
                const Mat3 inverse =
                    Eigen::CompleteOrthogonalDecomposition<Mat3>(S * system.diagonal[row] * S)
                        .setThreshold(1e-9)
                        .pseudoInverse();
                const Vec3 r = S * (system.b[row] - row_times(system, row, ws.x)), b = S * system.b[row];
                residual += r.dot(inverse * r);
                right += b.dot(inverse * b);
            }
            return std::sqrt(residual / right);
        };
        for (const Preconditioner kind :
             {Preconditioner::none, Preconditioner::diagonal, Preconditioner::block,
              Preconditioner::constrained_block, Preconditioner::ssor, Preconditioner::ic0}) {
            ComponentSolve took, shorter;
            const double residual = stopped(kind, 5000, took);
            INFO("preconditioner " << static_cast<int>(kind) << ", seed " << seed);
            REQUIRE(took.converged);
            REQUIRE(took.iterations > 1);
            CHECK(residual <= tolerance * (1 + 1e-6));
            CHECK(took.residual == Approx(residual).epsilon(1e-6));
            CHECK(stopped(kind, static_cast<int>(took.iterations) - 1, shorter) > tolerance);
            CHECK_FALSE(shorter.converged);
        }
    }
}

TEST_CASE("the decomposed solve matches the whole-system solve and needs no more multiplies") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Problem problem(40, 0.04, 0.2, 0.2, seed);
        std::vector<ComponentSolve> parts, whole;
        const Components components = problem.decomposed();
        const std::vector<Vec3> x =
            problem.solved(components, Preconditioner::constrained_block, 1e-11, parts);
        const std::vector<Vec3> y =
            problem.solved(problem.whole(), Preconditioner::constrained_block, 1e-11, whole);
        CHECK(difference(x, y) < 1e-8);
        REQUIRE(components.count() > 1);
        std::uint64_t rvm = 0;
        for (const ComponentSolve& s : parts) rvm += s.rvm;
        CHECK(rvm < whole.front().rvm);
    }
}

TEST_CASE(
    "what acts along constrained directions alone is no right-hand side: the solution is found at once") {
    Problem problem(60, 0.1, 0.1, 0.6, 11);
    const std::span<const Constraint> all = problem.constraints.all();
    std::vector<Constraint> at_rest(all.begin(), all.end());
    problem.constraints.reset(problem.n);
    for (std::size_t p = 0; p < problem.n; ++p) problem.impulse[p] = problem.drift[p] = Vec3::Zero();
    for (Constraint& c : at_rest) {
        c.z.setZero();
        problem.constraints.add(c);
        const Vec3 push = problem.vector();
        problem.impulse[c.particle] = push - c.S * push;
    }
    std::vector<ComponentSolve> solves;
    const std::vector<Vec3> x =
        problem.solved(problem.whole(), Preconditioner::constrained_block, 1e-3, solves);
    for (const ComponentSolve& s : solves) CHECK(s.converged);
    for (const Vec3& dv : x) CHECK(dv.norm() < 1e-12);
}

TEST_CASE("prescribed values hold to rounding") {
    const Problem problem(30, 0.2, 0.2, 0.5, 3);
    std::vector<ComponentSolve> solves;
    const std::vector<Vec3> x =
        problem.solved(problem.decomposed(), Preconditioner::constrained_block, 1e-3, solves);
    for (const Constraint& c : problem.constraints.all()) {
        const Mat3 fixed = Mat3::Identity() - c.S;
        CHECK((fixed * (x[c.particle] - c.z)).norm() < 1e-13);
    }
}

TEST_CASE("a large component solved in chunks matches a direct factorisation") {
    // A chain longer than a chunk of rows: parallel inside the component.
    Problem chain(1, 0, 0, 0, 5);
    const std::size_t n = 3 * chunk_size + 17;
    chain.n = n;
    chain.mass.assign(n, 0.01);
    chain.impulse.clear();
    chain.drift.clear();
    chain.guess.assign(n, Vec3::Zero());
    for (std::uint32_t p = 0; p < n; ++p) {
        chain.impulse.push_back(0.1 * chain.vector());
        chain.drift.push_back(Vec3::Zero());
        if (p + 1 == n) continue;
        chain.springs.i.push_back(p);
        chain.springs.j.push_back(p + 1);
        chain.springs.stiffness.push_back(50);
        chain.springs.damping.push_back(0.01);
        chain.forces.direction.push_back(chain.vector().normalized());
        chain.forces.transverse.push_back(10);
        chain.forces.state.push_back(SpringState::implicit);
    }
    chain.adjacency = adjacency_of(n, chain.springs.i, chain.springs.j);
    chain.constraints.reset(n);
    std::vector<ComponentSolve> solves;
    const Components components = chain.decomposed();
    REQUIRE(components.count() == 1);
    const std::vector<Vec3> x = chain.solved(components, Preconditioner::constrained_block, 1e-12, solves);
    const System system = chain.assembled(components);
    for (std::uint32_t row = 0; row < n; ++row) {
        CHECK((row_times(system, row, x) - system.b[row]).norm() < 1e-9);
    }
}

TEST_CASE("constrained block is the exact inverse of the projected block on range(S)") {
    const Problem problem(12, 0.5, 0.1, 0.8, 9);
    const Components components = problem.decomposed();
    const System system = problem.assembled(components);
    BlockPreconditioner P;
    build_preconditioner(Preconditioner::constrained_block, system, components, problem.constraints, P);
    for (std::uint32_t row = 0; row < components.start.back(); ++row) {
        const Constraint* c = problem.constraints.find(components.order[row]);
        const Mat3 S = c ? c->S : Mat3(Mat3::Identity());
        // S C S P' = S
        CHECK((S * system.diagonal[row] * S * P.inverse[row] - S).norm() < 1e-10);
        CHECK((P.inverse[row] - P.inverse[row].transpose()).norm() == 0);
    }
}

TEST_CASE("the assembled matrix is symmetric positive definite for unequal masses") {
    const Problem problem(15, 0.4, 0, 0, 11);
    const System system = problem.assembled(problem.whole());
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(45, 45);
    for (std::uint32_t row = 0; row < 15; ++row) {
        A.block<3, 3>(3 * row, 3 * row) = system.diagonal[row];
        for (std::uint32_t e = system.start[row]; e < system.start[row + 1]; ++e) {
            const System::Entry& entry = system.entries[e];
            A.block<3, 3>(3 * row, 3 * entry.column) -=
                entry.a * Mat3::Identity() + entry.w * entry.w.transpose();
        }
    }
    CHECK((A - A.transpose()).norm() < 1e-14 * A.norm());
    const double lightest = *std::min_element(problem.mass.begin(), problem.mass.end());
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues().minCoeff() >=
          lightest * (1 - 1e-9));
}
