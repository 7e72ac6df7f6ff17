#include "tool/bench/measured_problem.hpp"

#include <tbb/task_arena.h>

#include <algorithm>

namespace unravel::tool {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// One component in place of many; the others stand aside like particles that are held. No implicit spring
// joins them to it.
Components only_largest(const Components& all) {
    Components out;
    out.label.assign(all.label.size(), -1);
    std::size_t c = 0;
    for (std::size_t k = 1; k < all.count(); ++k) c = all.size(k) > all.size(c) ? k : c;
    const auto begin = all.order.begin() + all.start[c], end = all.order.begin() + all.start[c + 1];
    out.order.assign(begin, end);
    out.order.insert(out.order.end(), all.order.begin(), begin);
    out.order.insert(out.order.end(), end, all.order.end());
    out.start = {0, all.size(c)};
    for (std::uint32_t k = 0; k < out.start[1]; ++k) out.label[out.order[k]] = 0;
    return out;
}

}  // namespace

MeasuredProblem::MeasuredProblem(const Scene& scene, double start, int threads)
    : simulation_(start_simulation(scene)) {
    simulation_.options.solve.preconditioner = Preconditioner::automatic;
    tbb::task_arena arena(threads);
    arena.execute([&] {
        while (simulation_.state.t < start) report_ = next_step(simulation_);
    });
    h_ = 1.0 / (simulation_.fps.per_second() * simulation_.steps_per_frame);
    if (simulation_.options.integrator == Integrator::automatic ||
        simulation_.options.integrator == Integrator::explicit_)
        simulation_.options.integrator = Integrator::adaptive_imex;
    simulation_.options.measure = false;
}

MeasuredProblem::Steps MeasuredProblem::run_steps(const StepKind& kind, int count) {
    StepOptions options = simulation_.options;
    options.integrator = kind.integrator;
    options.solve.preconditioner = kind.preconditioner;
    options.decompose = kind.decompose;
    options.substeps = 0;
    ClothState state = simulation_.state;
    Steps out;
    tbb::task_arena arena(kind.threads);
    arena.execute([&] {
        step(simulation_.model, options, h_, state, simulation_.ws);
        for (int k = 0; k < count; ++k) {
            const auto start = Clock::now();
            const StepReport report = step(simulation_.model, options, h_, state, simulation_.ws);
            out.seconds += since(start) / count;
            out.stages += report.times;
            out.substeps += static_cast<double>(report.substeps) / count;
            out.iterations += static_cast<double>(report.cg_iterations_max) / count;
        }
    });
    for (double StageTimes::*slot :
         {&StageTimes::contact, &StageTimes::collision, &StageTimes::air, &StageTimes::forces,
          &StageTimes::graph, &StageTimes::assembly, &StageTimes::solve, &StageTimes::advance})
        out.stages.*slot /= count;
    return out;
}

void MeasuredProblem::capture(int threads) {
    ClothState state = simulation_.state;
    guess_ = state.dv;
    tbb::task_arena arena(threads);
    const StepReport report = arena.execute(
        [&] { return step(simulation_.model, simulation_.options, h_, state, simulation_.ws); });
    constrained_ = report.constrained;
    const StepTrace trace = trace_of(simulation_.model, simulation_.ws);
    couplings_ = trace.couplings;
    load_ = trace.load;
    stage_h_ = trace.h;
    components_ = trace.components;
    constraints_ = trace.constraints;
    largest_ = only_largest(components_);
}

StepSystem MeasuredProblem::system(const Components& components) const {
    return {simulation_.model.grids,    couplings_, load_, components, constraints_, guess_, stage_h_,
            &simulation_.model.stitches};
}

MeasuredProblem::Solve MeasuredProblem::solve(const Components& components, const SolveOptions& options,
                                              int threads) {
    const StepSystem step = system(components);
    Solve out;
    tbb::task_arena arena(threads);
    arena.execute([&] {
        const auto start = Clock::now();
        assemble_components(step, options, grids_, rows_system_);
        out.set_up = since(start);
        solve_components(step, options, grids_, rows_system_, solve_, solves_);
        out.seconds = since(start);
    });
    for (const ComponentSolve& s : solves_) {
        out.rvm += s.rvm;
        out.iterations = std::max<double>(out.iterations, s.iterations);
    }
    return out;
}

MeasuredProblem::Solve MeasuredProblem::solve(const SolveOptions& options, int threads) {
    return solve(components_, options, threads);
}

MeasuredProblem::Solve MeasuredProblem::solve_largest(const SolveOptions& options, int threads) {
    return solve(largest_, options, threads);
}

std::vector<Vec3> MeasuredProblem::solution() const {
    std::vector<Vec3> dv(components_.order.size());
    for (std::size_t row = 0; row < dv.size(); ++row) dv[components_.order[row]] = solve_.x[row];
    return dv;
}

const GridSystem* MeasuredProblem::grid() const {
    const GridSystem* largest = nullptr;
    for (std::size_t k = 0; k < grids_.plan.on_grid.size(); ++k) {
        const GridSystem& system = grids_.grids[k]->system;
        if (grids_.grids[k]->solved && (!largest || system.rows > largest->rows)) largest = &system;
    }
    return largest && largest->rows == components_.largest() ? largest : nullptr;
}

FoldedSystem MeasuredProblem::folded() {
    const StepSystem step = system(components_);
    assemble(step.couplings, step.load, step.components, step.constraints, step.h, rows_system_);
    const std::uint32_t rows = components_.start.back();
    rows_ = rows;
    entries_ =
        rows_system_.start[rows] + (rows_system_.block_start.empty() ? 0 : rows_system_.block_start[rows]);
    return fold(step, rows_system_);
}

}  // namespace unravel::tool
