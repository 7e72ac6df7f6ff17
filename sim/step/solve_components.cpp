#include "sim/step/solve_components.hpp"

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/linear/conjugate_gradients.hpp"

namespace unravel::sim {

namespace {

// A component that covers less than this share of its rows of the grid wastes too much of every sweep.
constexpr double least_share = 0.3;
// Stiffest coupling over mass that single precision bears.
constexpr double stiffest_in_float = 1e5;

const GridSprings* grid_of(std::span<const GridSprings> grids, std::uint32_t particle) {
    for (const GridSprings& g : grids) {
        if (particle >= g.particle && particle < g.particle + g.count()) return &g;
    }
    return nullptr;
}

// f(s) for those of `count` bend springs that are no arcs between a grid's neighbours.
template <typename F>
void each_bend_beyond(std::span<const GridSprings> grids, std::size_t count, const F& f) {
    std::size_t next = 0;
    const auto until = [&](std::size_t end) {
        for (; next < end; ++next) f(next);
    };
    for (const GridSprings& grid : grids) {
        if (!arcs_between_neighbours(grid)) continue;
        for (const SpringRows* rows : {&grid.bend_u, &grid.bend_v}) {
            if (rows->count() == 0) continue;
            until(rows->first);
            next += rows->count();
        }
    }
    until(count);
}

// Which components have what is on no grid: springs between cloth that touches itself, stitches, arcs over
// two cells, and stencils but for bending's.
void mark_beyond_grids(std::span<const GridSprings> grids, const Couplings& couplings,
                       const Components& components, std::vector<std::uint8_t>& beyond) {
    beyond.assign(components.count(), 0);
    const auto mark = [&](std::uint32_t p) {
        if (components.label[p] >= 0) beyond[static_cast<std::size_t>(components.label[p])] = 1;
    };
    const BendCouplings* const bending = couplings.bending;
    for (std::size_t k = 1; k < couplings.springs.size(); ++k) {
        const SpringFamily& family = couplings.springs[k];
        const auto mark_ends = [&](std::size_t s) {
            if (family.forces->state[s] != SpringState::implicit) return;
            mark(family.springs->i[s]);
            mark(family.springs->j[s]);
        };
        const std::size_t count = family.forces->state.size();
        if (bending && k == bending->arcs) {
            each_bend_beyond(grids, count, mark_ends);
        } else {
            for (std::size_t s = 0; s < count; ++s) mark_ends(s);
        }
    }
    for (std::size_t list = 0; list < couplings.stencils.size(); ++list) {
        if (bending && list == bending->list) continue;
        const Stencils& stencils = couplings.stencils[list];
        for (std::size_t s = 0; s < stencils.list.size(); ++s) {
            if (!stencils.is_implicit(s)) continue;
            const Stencil& stencil = stencils.list[s];
            for (std::uint32_t k = 0; k < stencil.count; ++k)
                if (stencil.w[k] != 0) mark(stencil.p[k]);
        }
    }
}

// Whether a component, whose first particle lies on `grid` or on none, goes to the grid's solver.
SolveReason why_on_grid(const Components& components, std::size_t c, const GridSprings* grid, bool beyond) {
    const std::uint32_t size = components.size(c);
    if (size < least_rows_on_grid) return SolveReason::few_rows;
    const std::uint32_t first = components.order[components.start[c]],
                        last = components.order[components.start[c + 1] - 1];
    if (!grid || last >= grid->particle + grid->count()) return SolveReason::on_no_grid;
    if (beyond) return SolveReason::beyond_grid;
    const std::uint32_t rows = (last - grid->particle) / grid->nu - (first - grid->particle) / grid->nu + 1;
    return size < least_share * rows * grid->nu ? SolveReason::sparse : SolveReason::on_grid;
}

// What rows solved although nobody asked for rows: the reason that kept it off the grid, unless it is
// cycles' own.
void explain_rows(const SolvePlan& plan, std::vector<ComponentSolve>& solves) {
    for (std::size_t c = 0; c < solves.size(); ++c) {
        if (solves[c].by != SolvedBy::rows || solves[c].because != SolveReason::few_rows) continue;
        const SolveReason kept_off = plan.because.empty() ? SolveReason::on_no_grid : plan.because[c];
        solves[c].because = kept_off == SolveReason::on_grid ? SolveReason::beyond_single : kept_off;
    }
}

void plan_solves(const StepSystem& step, const SolveOptions& options, GridSolves& ws) {
    const std::span<const GridSprings> grids = step.grids;
    const Components& components = step.components;
    SolvePlan& plan = ws.plan;
    plan.on_grid.clear();
    plan.elsewhere.clear();
    plan.because.clear();
    if (!may_use_grids(options) || grids.empty()) return;
    mark_beyond_grids(grids, step.couplings, components, ws.beyond);
    plan.because.resize(components.count());
    for (std::size_t c = 0; c < components.count(); ++c) {
        const GridSprings* const g = grid_of(grids, components.order[components.start[c]]);
        plan.because[c] = why_on_grid(components, c, g, ws.beyond[c] != 0);
        if (plan.because[c] == SolveReason::on_grid)
            plan.on_grid.push_back({static_cast<std::uint32_t>(c), g});
    }
    if (plan.on_grid.empty()) return;
    plan.elsewhere.assign(components.count(), 0);
    for (const SolvePlan::OnGrid& task : plan.on_grid) plan.elsewhere[task.component] = 1;
}

// A grid's reach is that of its stiffest spring.
bool pays_multigrid(const GridSystem& system) {
    return expected_iterations(std::sqrt(system.stiffest), system.rows) > iterations_worth_cycles;
}

void solve_grid(const SolveOptions& options, GridSolves::Grid& grid) {
    const bool chooses = options.preconditioner == Preconditioner::automatic;
    const bool multigrid =
        options.preconditioner == Preconditioner::multigrid || (chooses && pays_multigrid(grid.system));
    const std::uint32_t patience = multigrid ? most_cycles_of_multigrid
                                   : chooses ? iterations_worth_cycles
                                             : std::numeric_limits<std::uint32_t>::max();
    grid.solved = grid.system.stiffest <= stiffest_in_float &&
                  solve_on_grid(grid.system, multigrid, patience, options, grid.cg, grid.solve);
}

void take_solution(const GridSystem& system, const Components& components, std::span<Vec3> x) {
    const std::uint32_t first = components.start[system.component];
    parallel_each(components.size(system.component), [&](std::size_t k) {
        const std::uint32_t node = components.order[first + k] - system.first_particle;
        const auto nu = static_cast<std::uint32_t>(system.grid.nu);
        const double* const p =
            system.x.data() +
            static_cast<std::size_t>(node / nu) * 3 * static_cast<std::size_t>(system.grid.pitch) +
            StencilGrid::margin + node % nu;
        x[first + k] = {p[0], p[system.grid.pitch], p[2 * system.grid.pitch]};
    });
}

// What cycles by aggregation walk on, made when the first component is there that may get them.
void make_aggregates_where_needed(const StepSystem& step, const SolveOptions& options,
                                  const std::vector<std::uint8_t>& elsewhere, SolveWorkspace& ws) {
    if (ws.aggregates.particles() > 0) return;
    const std::uint32_t least = least_rows_of_aggregation(options.preconditioner);
    bool needed = false;
    for (std::size_t c = 0; c < step.components.count(); ++c)
        needed = needed || (step.components.size(c) >= least && (elsewhere.empty() || !elsewhere[c]));
    if (!needed) return;
    std::vector<Aggregates::Join> joins;
    if (step.stitches) {
        const Stitches& all = *step.stitches;
        for (std::size_t s = 0; s < all.size(); ++s) joins.push_back({all.i[s], all.j[s], all.stiffness[s]});
    }
    ws.aggregates = make_aggregates(step.load.mass.size(), *step.couplings.springs[0].springs, joins);
}

}  // namespace

bool may_use_grids(const SolveOptions& options) {
    return (options.preconditioner == Preconditioner::automatic ||
            options.preconditioner == Preconditioner::stencil_block ||
            options.preconditioner == Preconditioner::multigrid) &&
           options.tolerance >= grid_cg_tolerance;
}

void assemble_components(const StepSystem& step, const SolveOptions& options, GridSolves& grids,
                         System& rows) {
    plan_solves(step, options, grids);
    const SolvePlan& plan = grids.plan;
    while (grids.grids.size() < plan.on_grid.size())
        grids.grids.push_back(std::make_unique<GridSolves::Grid>());
    GridBending bending;
    if (const BendCouplings* const bends = step.couplings.bending)
        bending = {bends->stencils, bends->is_implicit, step.couplings.springs[bends->arcs].springs};
    tbb::task_group giants;
    for (std::size_t k = 0; k < plan.on_grid.size(); ++k) {
        giants.run([&, k] {
            const GridSprings& grid = *plan.on_grid[k].springs;
            load_grid_system(grid, step.couplings.springs[0], step.load, step.components,
                             plan.on_grid[k].component, step.constraints, step.guess, step.h,
                             grids.grids[k]->system, arcs_between_neighbours(grid) ? bending : GridBending{});
        });
    }
    assemble(step.couplings, step.load, step.components, step.constraints, step.h, rows, plan.elsewhere);
    giants.wait();
}

void solve_components(const StepSystem& step, const SolveOptions& options, GridSolves& grids, System& rows,
                      SolveWorkspace& ws, std::vector<ComponentSolve>& out) {
    SolvePlan& plan = grids.plan;
    const auto solve_rows = [&] {
        make_aggregates_where_needed(step, options, plan.elsewhere, ws);
        solve(rows, step.components, step.constraints, step.guess, options, ws, out);
    };
    tbb::task_group giants;
    for (std::size_t k = 0; k < plan.on_grid.size(); ++k)
        giants.run([&, k] { solve_grid(options, *grids.grids[k]); });
    solve_rows();
    giants.wait();

    // What single precision could not solve goes the long way.
    bool failed = false;
    for (std::size_t k = 0; k < plan.on_grid.size(); ++k) {
        plan.elsewhere[plan.on_grid[k].component] = grids.grids[k]->solved;
        failed = failed || !grids.grids[k]->solved;
    }
    if (failed) {
        assemble(step.couplings, step.load, step.components, step.constraints, step.h, rows, plan.elsewhere);
        solve_rows();
    }
    explain_rows(plan, out);
    for (std::size_t k = 0; k < plan.on_grid.size(); ++k) {
        if (!grids.grids[k]->solved) continue;
        out[plan.on_grid[k].component] = grids.grids[k]->solve;
        take_solution(grids.grids[k]->system, step.components, ws.x);
    }
}

}  // namespace unravel::sim
