// Components solved on a grid's stencil, in single precision, against the rows' solver in double.

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "sim/forces/bend.hpp"
#include "sim/forces/curvature.hpp"
#include "sim/scene/random.hpp"
#include "sim/step/trace.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

struct ListForm {
    const char* name;
    int nu, nv;
    bool tube;
};
constexpr ListForm layouts[] = {{"open", 37, 29, false},
                                {"wide", 64, 20, false},
                                {"tube", 24, 17, true},
                                {"odd tube", 25, 18, true},
                                {"tube of half a vector more", 20, 13, true},
                                {"ribbon", 1, 150, false},
                                {"row", 150, 1, false},
                                {"tiny", 5, 3, false},
                                {"narrow tube", 20, 13, true},
                                {"ring", 3, 4, true},
                                {"pair", 2, 1, false}};

enum Held : unsigned { nothing = 0, pins = 1, contacts = 2 };

// A rippled sheet under load, some springs slack, some particles held.
struct Sheet {
    Placement placement;
    ClothModel model;
    ExtensionForces forces;
    Constraints constraints;
    Components components;
    std::vector<Vec3> impulse, drift, guess, at;
    std::vector<std::uint8_t> is_implicit;  // of bending's stencils
    std::vector<Stencil> bends;
    ImplicitBend arcs;
    Adjacency arc_adjacency;
    std::uint64_t draw = 0;
    static constexpr double h = 0.005;

    double uniform() { return seeded_uniform(7, draw++); }
    Vec3 vector() { return {uniform(), uniform(), uniform()}; }

    Sheet(const ListForm& layout, unsigned held, double slack = 0.0, double bend = 0.0) {
        Scene scene;
        scene.cloths = {testing::sheet(2, 1.0)};
        Cloth& cloth = scene.cloths[0];
        cloth.particles = {layout.nu, layout.nv};
        cloth.wrap = layout.tube ? Wrap::tube : Wrap::open;
        cloth.material.stretch = {50, 50};
        cloth.material.shear = 5;
        cloth.material.bend = bend;
        cloth.bend_model = BendModel::curvature;
        model = build_model(scene, placement);
        const std::size_t n = model.size();
        for (std::size_t p = 0; p < n; ++p) {
            impulse.push_back(model.mass[p] * (Vec3(0, -9.81 * h, 0) + 0.1 * vector()));
            drift.push_back(1e-4 * vector());
            guess.push_back(0.05 * vector());
        }
        // Stretched, bent every way, here and there slack.
        for (const Vec3& x : placement.x) at.push_back(1.03 * x + 0.05 * model.springs.rest[0] * vector());
        forces.state.resize(model.springs.size());
        for (std::size_t s = 0; s < model.springs.size(); ++s) {
            forces.state[s] = 0.5 * (1 + uniform()) < slack ? SpringState::inactive : SpringState::implicit;
        }
        make_bends(slack);
        constraints.reset(n);
        for (std::uint32_t p = 0; p < n; ++p) {
            const double pick = 0.5 * (1 + uniform());
            const int i = static_cast<int>(p) % layout.nu, j = static_cast<int>(p) / layout.nu;
            if ((held & pins) && j == 0 && i <= layout.nu / 10) {
                constraints.add({p, 0, Mat3::Zero(), 0.1 * vector()});
            } else if ((held & contacts) && j > layout.nv / 3 && pick < 0.6) {
                const Vec3 normal = (Vec3(0, 1, 0) + 0.3 * vector()).normalized();
                const Mat3 two = Mat3::Identity() - normal * normal.transpose();
                const Vec3 other = normal.unitOrthogonal();
                if (pick < 0.2)
                    constraints.add({p, 0, Mat3::Zero(), 0.01 * vector()});
                else if (pick < 0.4)
                    constraints.add({p, 2, two, 0.01 * normal});
                else
                    constraints.add({p, 1, two - other * other.transpose(), 0.01 * normal});
            }
        }
        std::vector<std::uint32_t> scratch;
        find_components(n, couplings().all(), constraints, scratch, components);
    }
    // All stencils are implicit, or, where some springs are slack, all but every fifth; and every arc that is
    // compressed.
    void make_bends(double slack) {
        for (std::size_t s = 0; s < model.curvature.size(); ++s) {
            is_implicit.push_back(slack == 0 || s % 5 != 0);
            if (is_implicit[s] != 0) bends.push_back(curvature_stencil(model.curvature, s));
        }
        BendLimit unlimited;
        limit_bend(model.bends, model.mass, 0, unlimited);
        bend_jacobians(model.bends, unlimited, at, arcs);
        arc_adjacency = adjacency_of(model.size(), model.bends.i, model.bends.j);
    }
    struct All {
        std::vector<SpringFamily> springs;
        std::vector<Stencils> stencils;
        BendCouplings bending;
        Couplings all() const { return {springs, stencils, springs.size() > 1 ? &bending : nullptr}; }
    };
    All couplings() const {
        if (model.curvature.size() == 0) return {{family()}, {}, {}};
        return {{family(), {&arcs.springs, &arc_adjacency, &arcs.forces}},
                {{bends}},
                {&model.curvature, is_implicit, 1, 0}};
    }
    GridBending bending() const { return {&model.curvature, is_implicit, &arcs.springs}; }
    SpringFamily family() const { return {&model.springs, &model.spring_adjacency, &forces, {}, at}; }
    std::vector<SpringFamily> families() const { return {family()}; }
    Load load() const { return {model.mass, impulse, drift}; }
};

struct Solved {
    bool reached = false;
    ComponentSolve solve;
    std::vector<Vec3> x;  // rows of the component, in order
};

Solved on_grid(const Sheet& sheet, std::uint32_t c, bool multigrid, double tolerance,
               std::uint32_t patience = 1000) {
    GridSystem system;
    load_grid_system(sheet.model.grids[0], sheet.family(), sheet.load(), sheet.components, c,
                     sheet.constraints, sheet.guess, Sheet::h, system, sheet.bending());
    GridCgWorkspace ws;
    Solved solved;
    SolveOptions options;
    options.tolerance = tolerance;
    solved.reached = solve_on_grid(system, multigrid, patience, options, ws, solved.solve);
    const Components& all = sheet.components;
    for (std::uint32_t row = all.start[c]; row < all.start[c + 1]; ++row) {
        const std::uint32_t node = all.order[row] - system.first_particle;
        const auto nu = static_cast<std::uint32_t>(system.grid.nu);
        const double* const p = system.x.data() +
                                (node / nu) * 3 * static_cast<std::size_t>(system.grid.pitch) +
                                StencilGrid::margin + node % nu;
        solved.x.emplace_back(p[0], p[system.grid.pitch], p[2 * system.grid.pitch]);
    }
    return solved;
}

}  // namespace

TEST_CASE("on a grid every component meets the stopping rule of the assembled system, whatever its layout") {
    for (const ListForm& layout : layouts) {
        for (const unsigned held : {+nothing, +pins, +contacts, pins | contacts}) {
            for (const auto& [slack, bend] :
                 {std::pair{0.0, 0.0}, {0.4, 0.0}, {0.0, 1e-2}, {0.4, 1e-4}, {0.9, 1e-3}}) {
                const Sheet sheet(layout, held, slack, bend);
                const Components& all = sheet.components;
                System A;
                assemble(sheet.couplings().all(), sheet.load(), all, sheet.constraints, Sheet::h, A);
                BlockPreconditioner P;
                build_preconditioner(Preconditioner::constrained_block, A, all, sheet.constraints, P);
                for (std::uint32_t c = 0; c < all.count(); ++c) {
                    for (const bool multigrid : {false, true}) {
                        const Solved solved = on_grid(sheet, c, multigrid, 1e-4);
                        INFO(layout.name << " held " << held << " slack " << slack << " bend " << bend
                                         << " component " << c << " of " << all.size(c) << " rows, multigrid "
                                         << multigrid);
                        REQUIRE(solved.reached);
                        CHECK(solved.solve.converged);
                        std::vector<Vec3> x(A.rows(), Vec3::Zero());
                        std::copy(solved.x.begin(), solved.x.end(), x.begin() + all.start[c]);
                        double residual = 0, right = 0;
                        for (std::uint32_t row = all.start[c]; row < all.start[c + 1]; ++row) {
                            const Vec3 r = A.b[row] - row_times(A, row, x);
                            residual += r.dot(P.inverse[row] * r);
                            right += A.b[row].dot(P.inverse[row] * A.b[row]);
                            if (const Constraint* held_by = sheet.constraints.find(all.order[row]))
                                CHECK((held_by->S * (x[row] - held_by->z) - (x[row] - held_by->z)).norm() <
                                      1e-7);
                        }
                        CHECK(std::sqrt(residual) <= 1.001e-4 * std::sqrt(right));
                        CHECK(solved.solve.residual <= 1e-4);
                    }
                }
            }
        }
    }
}

TEST_CASE("multigrid's iterations do not grow with the sheet") {
    for (const int n : {32, 64, 128, 256}) {
        const Sheet sheet({"sheet", n, n, false}, pins);
        REQUIRE(sheet.components.count() == 1);
        const Solved lines = on_grid(sheet, 0, true, 1e-3);
        CHECK(lines.reached);
        CHECK(lines.solve.iterations <= 8);
    }
}

// h²λ of the stencils grows from 1 to 3,400 over these sheets: beyond, lines that hold bending as a diagonal
// gain less and less.
TEST_CASE("bending adds few iterations to multigrid's and leaves blocks behind") {
    for (const int n : {32, 64, 128, 256}) {
        const Sheet sheet({"sheet", n, n, false}, pins, 0.0, 1e-4);
        REQUIRE(sheet.components.count() == 1);
        const Solved lines = on_grid(sheet, 0, true, 1e-3);
        INFO(n << ": " << lines.solve.iterations);
        CHECK(lines.reached);
        CHECK(lines.solve.iterations <= 12);
    }
}

TEST_CASE("on a grid either preconditioner takes over from the other") {
    for (const ListForm& layout : {layouts[0], layouts[2]}) {
        const Sheet sheet(layout, pins | contacts);
        for (const bool multigrid : {false, true}) {
            const Solved alone = on_grid(sheet, 0, multigrid, 1e-4);
            const Solved helped = on_grid(sheet, 0, multigrid, 1e-4, 2);
            CHECK(helped.reached);
            CHECK(helped.solve.converged);
            CHECK((helped.solve.iterations < alone.solve.iterations) == !multigrid);
        }
    }
}

TEST_CASE("on a grid one thread equals many, bit for bit") {
    for (const auto& [multigrid, bend] : {std::pair{false, 0.0}, {true, 0.0}, {false, 1e-3}, {true, 1e-3}}) {
        const Sheet sheet({"sheet", 90, 80, false}, pins | contacts, 0.1, bend);
        const auto with = [&](std::size_t threads) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            return on_grid(sheet, 0, multigrid, 1e-3);
        };
        CAPTURE(multigrid, bend);
        const Solved one = with(1), many = with(5);
        CHECK(one.solve.iterations == many.solve.iterations);
        REQUIRE(one.x.size() == many.x.size());
        CHECK(std::memcmp(one.x.data(), many.x.data(), one.x.size() * sizeof(Vec3)) == 0);
    }
}

TEST_CASE("kernels of every instruction set give the same bits") {
    const Sheet sheet({"tube", 45, 30, true}, contacts, 0.1, 1e-3);
    GridSystem system;
    load_grid_system(sheet.model.grids[0], sheet.family(), sheet.load(), sheet.components, 0,
                     sheet.constraints, sheet.guess, Sheet::h, system, sheet.bending());
    const StencilGrid& g = system.grid;
    const auto run = [&](const StencilKernels& kernels) {
        std::vector<float> r(system.field(3)), z(system.field(3)), p(system.field(3)), q(system.field(3)),
            t(system.field(3)), E(system.field(6)), scratch(static_cast<std::size_t>(64 * g.pitch)),
            lines(static_cast<std::size_t>((g.nv + 7) / 8 * 80 * g.columns()));
        std::vector<double> dots(static_cast<std::size_t>(g.nv)),
            wide(static_cast<std::size_t>(64 * g.pitch));
        kernels.sweep.residual(g, 0, g.nv, system.b.data(), system.x.data(), system.P.data(), r.data(),
                               dots.data(), wide.data());
        kernels.line.factor_v[0](g, 0, g.columns(), system.D.data(), E.data());
        const int line = 80 * g.columns();
        for (int k = 0; 8 * k < g.nv; ++k) {
            kernels.line.factor_u[0](g, k, system.D.data(), lines.data() + k * line);
            kernels.line.solve_u[0](g, k, lines.data() + k * line, r.data(), z.data(), false, scratch.data());
        }
        kernels.transfer.close_rings(g, 0, g.nv, z.data());
        kernels.sweep.defect[0](g, 0, g.nv, r.data(), z.data(), t.data(), scratch.data());
        kernels.line.solve_v[0](g, 0, g.columns(), E.data(), t.data(), z.data(), true);
        kernels.sweep.direction(g, 0, g.nv, 0.5f, z.data(), r.data(), p.data(), q.data(), dots.data(),
                                scratch.data());
        kernels.bending.take(g, 0, g.nv, z.data(), t.data(), scratch.data());
        kernels.bending.add(g, 0, g.nv, p.data(), q.data(), dots.data(), scratch.data());
        std::vector<double> bent(system.field(3));
        kernels.bending.take_in_double(g, 0, g.nv, system.b.data(), system.x.data(), bent.data(),
                                       wide.data());
        for (int j = 0; j < g.nv; ++j) {
            for (int i = 0; i < g.nu; ++i)
                q.push_back(static_cast<float>(bent[static_cast<std::size_t>(3 * j * g.pitch + 8 + i)]));
        }
        q.insert(q.end(), t.begin(), t.end());
        q.insert(q.end(), z.begin(), z.end());
        for (const double dot : dots) q.push_back(static_cast<float>(dot));
        return q;
    };
    const std::vector<float> plain = run(plain_stencil_kernels()), best = run(stencil_kernels());
    CHECK(std::memcmp(plain.data(), best.data(), plain.size() * sizeof(float)) == 0);
}

TEST_CASE("steps solved on grids follow those solved by rows, several cloths at once") {
    Scene scene = testing::drape(24);
    scene.cloths.push_back(testing::sheet(20, 1.3));
    scene.cloths.back().name = "second";
    scene.cloths.back().wrap = Wrap::tube;
    scene.cloths.back().material.stretch = {900, 900};
    scene.solver.tolerance = 2e-6;
    const auto run = [&](Preconditioner kind) {
        scene.solver.preconditioner = kind;
        Simulation simulation = start_simulation(scene);
        std::size_t grids = 0;
        for (int k = 0; k < 20; ++k) {
            const StepReport report =
                step(simulation.model, simulation.options, 0.005, simulation.state, simulation.ws);
            CHECK(report.converged);
            grids = std::max(grids, trace_of(simulation.model, simulation.ws).grids.plan.on_grid.size());
        }
        CHECK((grids > 0) == (kind != Preconditioner::constrained_block));
        return simulation.state.x;
    };
    const std::vector<Vec3> rows = run(Preconditioner::constrained_block);
    for (const Preconditioner kind :
         {Preconditioner::automatic, Preconditioner::stencil_block, Preconditioner::multigrid}) {
        const std::vector<Vec3> grid = run(kind);
        double most = 0;
        for (std::size_t p = 0; p < rows.size(); ++p) most = std::max(most, (rows[p] - grid[p]).norm());
        CHECK(most < 1e-5);
    }
}

TEST_CASE("steps whose bending is implicit are solved on grids and follow those solved by rows") {
    Scene scene = testing::drape(24);
    scene.cloths[0].bend_model = BendModel::curvature;
    scene.cloths[0].material.bend = 2e-3;
    scene.cloths.push_back(testing::sheet(20, 1.3));
    scene.cloths.back().name = "second";
    scene.cloths.back().wrap = Wrap::tube;
    scene.cloths.back().material = scene.cloths[0].material;
    scene.cloths.back().bend_model = BendModel::curvature;
    scene.solver.tolerance = 2e-6;
    // Each step is taken by rows, and on grids from the same state.
    for (const Activation activation : {Activation::predicted, Activation::ahead}) {
        scene.solver.activation = activation;
        Simulation rows = start_simulation(scene), grids = start_simulation(scene);
        rows.options.solve.preconditioner = Preconditioner::constrained_block;
        for (int k = 0; k < 16; ++k) {
            grids.options.solve.preconditioner =
                k % 2 == 0 ? Preconditioner::stencil_block : Preconditioner::multigrid;
            grids.state = rows.state;
            CHECK(step(rows.model, rows.options, 0.01, rows.state, rows.ws).converged);
            CHECK(step(grids.model, grids.options, 0.01, grids.state, grids.ws).converged);
            CHECK(trace_of(rows.model, rows.ws).grids.plan.on_grid.empty());
            CHECK(trace_of(grids.model, grids.ws).grids.plan.on_grid.size() > 0);
            double most = 0;
            for (std::size_t p = 0; p < rows.model.size(); ++p)
                most = std::max(most, (rows.state.x[p] - grids.state.x[p]).norm());
            CHECK(most < 1e-6);
        }
    }
}

TEST_CASE("a grid's component that a stencil has a part in is solved by rows, with the stencil in it") {
    const Sheet sheet(layouts[0], pins);
    const std::vector<SpringFamily> families = sheet.families();
    Stencil touch;
    touch.count = 4;
    touch.p = {5 * 37 + 7, 20 * 37 + 7, 20 * 37 + 8, 21 * 37 + 7};
    touch.w = {1, -0.3, -0.3, -0.4};
    touch.u = Vec3(1, 2, 2) / 3;
    touch.along = 3000;
    touch.damping_across = 0.1;
    const Load load = sheet.load();
    for (const bool touched : {false, true}) {
        const Stencils lists[] = {{std::span(&touch, touched ? 1 : 0)}};
        const Couplings all{families, lists};
        Components components;
        std::vector<std::uint32_t> scratch;
        find_components(sheet.model.size(), all, sheet.constraints, scratch, components);
        REQUIRE(components.count() == 1);
        const StepSystem step{sheet.model.grids, all,         load,    components,
                              sheet.constraints, sheet.guess, Sheet::h};
        GridSolves grids;
        System rows;
        SolveWorkspace ws;
        std::vector<ComponentSolve> solves;
        SolveOptions options;
        options.preconditioner = Preconditioner::automatic;
        options.tolerance = 1e-6;
        assemble_components(step, options, grids, rows);
        CHECK(grids.plan.on_grid.size() == (touched ? 0 : 1));
        solve_components(step, options, grids, rows, ws, solves);
        CHECK(solves[0].converged);
        // What it solved is the whole of it.
        System A;
        assemble(all, load, components, sheet.constraints, Sheet::h, A);
        double residual = 0, right = 0;
        for (std::uint32_t row = 0; row < components.size(0); ++row) {
            residual += (row_times(A, row, ws.x) - A.b[row]).squaredNorm();
            right += A.b[row].squaredNorm();
        }
        CHECK(residual < 1e-8 * right);
    }
}
