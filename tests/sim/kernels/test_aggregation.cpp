// Cycles by aggregation on cloth that is no grid.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <numeric>

#include "sim/linear/aggregation.hpp"
#include "sim/scene/random.hpp"
#include "sim/step/solve_components.hpp"
#include "tests/allocations.hpp"
#include "tests/sim/kernels/loose_mesh.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

struct MeshSolver {
    GridSolves grids;
    System rows;
    SolveWorkspace ws;
    std::vector<ComponentSolve> solves;

    ComponentSolve run(const Mesh& mesh, Preconditioner kind, double tolerance) {
        const std::vector<SpringFamily> families = mesh.families();
        return run(mesh, families, mesh.load(), kind, tolerance);
    }
    ComponentSolve run(const Mesh& mesh, std::span<const SpringFamily> families, const Load& load,
                       Preconditioner kind, double tolerance) {
        SolveOptions options;
        options.preconditioner = kind;
        options.tolerance = tolerance;
        const Stencils lists[] = {{mesh.stencils}};
        const StepSystem step{{},     {families, lists}, load, mesh.components, mesh.constraints, mesh.guess,
                              Mesh::h};
        assemble_components(step, options, grids, rows);
        solve_components(step, options, grids, rows, ws, solves);
        return solves[mesh.largest()];
    }
};

Vec3 filtered(const Constraint* c, const Vec3& y) {
    return c ? Vec3(c->S * y) : y;
}

// Checks that the cycle for the largest component is symmetric and positive and keeps to the free directions;
// the largest eigenvalue of M⁻¹ A.
double check_cycle(Mesh& mesh) {
    const System A = mesh.system();
    const std::vector<const Constraint*> constraint = mesh.by_row();
    const std::size_t c = mesh.largest();
    const std::uint32_t begin = mesh.components.start[c], end = mesh.components.start[c + 1];
    Aggregation cycle;
    cycle.build(A, mesh.components, c, make_aggregates(mesh.mass.size(), mesh.springs, {}), constraint);
    std::vector<Vec3> a(A.rows()), b(A.rows()), Ma(A.rows()), Mb(A.rows());
    const auto dot = [&](const std::vector<Vec3>& x, const std::vector<Vec3>& y) {
        double sum = 0;
        for (std::uint32_t row = begin; row < end; ++row) sum += x[row].dot(y[row]);
        return sum;
    };
    for (std::uint32_t row = begin; row < end; ++row) {
        a[row] = 1e-6 * filtered(constraint[row], mesh.vector());
        b[row] = 1e-6 * filtered(constraint[row], mesh.vector());
    }
    cycle.apply(a, Ma);
    cycle.apply(b, Mb);
    const double aa = dot(a, Ma), bb = dot(b, Mb);
    CHECK(aa > 0);
    CHECK(bb > 0);
    CHECK(std::abs(dot(a, Mb) - dot(b, Ma)) < 1e-4 * std::sqrt(aa * bb));
    // The largest eigenvalue of M⁻¹ A, by powers: r = A z, z = M⁻¹ r.
    double largest = 0, leak = 0;
    for (int k = 0; k < 30; ++k) {
        for (std::uint32_t row = begin; row < end; ++row)
            a[row] = filtered(constraint[row], row_times(A, row, Ma));
        const double before = dot(Ma, a);
        cycle.apply(a, Mb);
        largest = dot(a, Mb) / before;
        const double scale = 1 / std::sqrt(dot(Mb, Mb));
        for (std::uint32_t row = begin; row < end; ++row) {
            Ma[row] = scale * Mb[row];
            const Vec3 outside = Ma[row] - filtered(constraint[row], Ma[row]);
            leak = std::max(leak, outside.norm() / (Ma[row].norm() + 1e-4));
        }
    }
    CHECK(leak < 1e-5);
    return largest;
}

void check_same_bits_for_any_threads(const Mesh& mesh) {
    std::vector<Vec3> first;
    for (const int threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads));
        tbb::task_arena arena(threads);
        MeshSolver solver;
        arena.execute([&] { CHECK(solver.run(mesh, Preconditioner::aggregation, 1e-6).converged); });
        if (first.empty()) first = solver.ws.x;
        CHECK(std::memcmp(first.data(), solver.ws.x.data(), first.size() * sizeof(Vec3)) == 0);
    }
}

}  // namespace

TEST_CASE("a cycle by aggregation is symmetric and positive, never above twice A's inverse") {
    for (const unsigned held : {+nothing, +corners, +contacts, corners | contacts}) {
        for (const double slack : {0.0, 0.3}) {
            for (const bool whole : {false, true}) {
                CAPTURE(held, slack, whole);
                Mesh mesh(45, held, 2000, slack, whole);
                const double largest = check_cycle(mesh);
                CHECK(largest < 1.2);
                CHECK(largest > 0.9);
            }
        }
    }
}

TEST_CASE("so is one on stencils, soft and stiff, whatever the sign of their couplings") {
    for (const unsigned held : {+nothing, +corners, +contacts, corners | contacts}) {
        for (const bool whole : {false, true}) {
            for (const auto& [bend, contact] : {std::pair{1.0, 50.0}, {200.0, 1e4}, {5000.0, 10.0}}) {
                CAPTURE(held, whole, bend, contact);
                Mesh mesh(45, held, 2000, 0.3, whole);
                mesh.couple(bend, contact, whole);
                const double largest = check_cycle(mesh);
                CHECK(largest < 2);
                CHECK(largest > 0.9);
            }
        }
    }
}

TEST_CASE("aggregation gives what a direct solve gives, under constraints of every kind") {
    for (const unsigned held : {+nothing, +corners, +contacts, corners | contacts}) {
        for (const double slack : {0.0, 0.3}) {
            CAPTURE(held, slack);
            const Mesh mesh(19, held, 2000, slack);
            MeshSolver solver;
            const ComponentSolve solved = solver.run(mesh, Preconditioner::aggregation, 1e-9);
            CHECK(solved.converged);
            const std::size_t c = mesh.largest();
            REQUIRE(solver.ws.aggregation_of[c] != nullptr);
            // S A S + (I − S) y = S (b − A (I − S) z), dense
            const System A = mesh.system();
            const std::vector<const Constraint*> constraint = mesh.by_row();
            const std::uint32_t begin = mesh.components.start[c], n = mesh.components.size(c);
            Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * n, 3 * n),
                            S = Eigen::MatrixXd::Identity(3 * n, 3 * n);
            Eigen::VectorXd b(3 * n), z = Eigen::VectorXd::Zero(3 * n);
            for (std::uint32_t k = 0; k < n; ++k) {
                const std::uint32_t row = begin + k;
                K.block<3, 3>(3 * k, 3 * k) = A.diagonal[row];
                for (std::uint32_t e = A.start[row]; e < A.start[row + 1]; ++e) {
                    const System::Entry& entry = A.entries[e];
                    K.block<3, 3>(3 * k, 3 * (entry.column - begin)) -=
                        entry.a * Mat3::Identity() + entry.w * entry.w.transpose();
                }
                b.segment<3>(3 * k) = A.b[row];
                if (!constraint[row]) continue;
                S.block<3, 3>(3 * k, 3 * k) = constraint[row]->S;
                z.segment<3>(3 * k) = constraint[row]->z - constraint[row]->S * constraint[row]->z;
            }
            const Eigen::VectorXd right = S * (b - K * z);
            const double scale = K.trace() / (3 * n);
            const Eigen::MatrixXd held_too =
                S * K * S + scale * (Eigen::MatrixXd::Identity(3 * n, 3 * n) - S);
            const Eigen::VectorXd x = S * held_too.ldlt().solve(right) + z;
            double most = 0, error = 0;
            for (std::uint32_t k = 0; k < n; ++k) {
                most = std::max(most, x.segment<3>(3 * k).norm());
                error = std::max(error, (solver.ws.x[begin + k] - x.segment<3>(3 * k)).norm());
            }
            CHECK(error < 1e-6 * most);
        }
    }
}

TEST_CASE("cycles by aggregation hardly grow with the mesh, and automatic takes them where it is stiff") {
    for (const int n : {50, 100, 200}) {
        const Mesh mesh(n, corners, 1000);
        MeshSolver fresh;
        const ComponentSolve solved = fresh.run(mesh, Preconditioner::aggregation, 1e-3);
        CAPTURE(n, solved.iterations);
        CHECK(solved.converged);
        CHECK(solved.iterations <= 16);
    }
    const Mesh stiff(70, corners, 4000), soft(70, corners, 5);
    const auto iterations = [](const Mesh& mesh, Preconditioner kind) {
        MeshSolver fresh;
        return fresh.run(mesh, kind, 1e-3).iterations;
    };
    CHECK(iterations(stiff, Preconditioner::automatic) == iterations(stiff, Preconditioner::aggregation));
    CHECK(5 * iterations(stiff, Preconditioner::automatic) <
          iterations(stiff, Preconditioner::constrained_block));
    CHECK(iterations(soft, Preconditioner::automatic) == iterations(soft, Preconditioner::constrained_block));
}

TEST_CASE("cycles by aggregation give the same bits for any number of threads") {
    const Mesh mesh(75, corners | contacts, 2000, 0.1);
    check_same_bits_for_any_threads(mesh);
}

TEST_CASE("cycles by aggregation allocate nothing after their first solve") {
    const Mesh mesh(40, corners | contacts, 2000);
    const std::vector<SpringFamily> families = mesh.families();
    const Load load = mesh.load();
    MeshSolver solver;
    tbb::task_arena arena(1);
    arena.execute([&] {
        solver.run(mesh, families, load, Preconditioner::aggregation, 1e-3);
        const testing::AllocationCount count;
        solver.run(mesh, families, load, Preconditioner::aggregation, 1e-3);
        CHECK(count.so_far() == 0);
    });
}

TEST_CASE("every particle is ordered once and every node has its aggregate") {
    const Mesh mesh(33, nothing, 100);
    const Aggregates::Join join{0, 5, 50.0};
    const Aggregates aggregates = make_aggregates(mesh.mass.size(), mesh.springs, {&join, 1});
    std::vector<std::uint32_t> sorted = aggregates.order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t p = 0; p < sorted.size(); ++p) REQUIRE(sorted[p] == p);
    REQUIRE(aggregates.parent.size() >= 3);
    std::size_t nodes = mesh.mass.size();
    for (const std::vector<std::uint32_t>& parent : aggregates.parent) {
        REQUIRE(parent.size() == nodes);
        const std::size_t next = *std::max_element(parent.begin(), parent.end()) + 1;
        std::vector<int> members(next, 0);
        for (const std::uint32_t node : parent) ++members[node];
        CHECK(*std::min_element(members.begin(), members.end()) >= 1);
        CHECK(*std::max_element(members.begin(), members.end()) <= 9);
        CHECK(3 * next < nodes);
        nodes = next;
    }
}

TEST_CASE(
    "aggregation solves what stencils couple, in few cycles, to the same bits for any number of threads") {
    const auto mesh_with = [](double bend, double contact) {
        Mesh mesh(60, corners | contacts, 1000, 0.1);
        mesh.couple(bend, contact, false);
        return mesh;
    };
    for (const auto& [bend, contact] : {std::pair{1.0, 50.0}, {20.0, 1000.0}}) {
        const Mesh mesh = mesh_with(bend, contact);
        MeshSolver solver, by_blocks;
        const ComponentSolve solved = solver.run(mesh, Preconditioner::aggregation, 1e-3);
        const ComponentSolve blocks = by_blocks.run(mesh, Preconditioner::constrained_block, 1e-3);
        CAPTURE(bend, contact, solved.iterations, blocks.iterations);
        CHECK(solved.converged);
        CHECK(3 * solved.iterations < blocks.iterations);
        const std::size_t c = mesh.largest();
        REQUIRE(solver.ws.aggregation_of[c] != nullptr);
        REQUIRE(!solver.rows.blocks.empty());
    }
    const Mesh mesh = mesh_with(5, 500);
    check_same_bits_for_any_threads(mesh);
}

TEST_CASE("an aggregation goes from springs to stencils and back as they come and go") {
    Mesh mesh(25, corners, 2000), coupled = mesh;
    coupled.couple(20, 500, false);
    REQUIRE(coupled.components.order == mesh.components.order);
    MeshSolver kept;
    for (const Mesh* const next : {&mesh, &coupled, &mesh, &coupled}) {
        MeshSolver fresh;
        CHECK(fresh.run(*next, Preconditioner::aggregation, 1e-6).converged);
        CHECK(kept.run(*next, Preconditioner::aggregation, 1e-6).converged);
        CHECK(std::memcmp(kept.ws.x.data(), fresh.ws.x.data(), fresh.ws.x.size() * sizeof(Vec3)) == 0);
    }
}
