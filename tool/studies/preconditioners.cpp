#include "tool/studies/preconditioners.hpp"

#include <cmath>

#include "sim/simulate.hpp"

namespace unravel {

namespace {

constexpr const char* names[] = {"none", "diagonal", "block", "constrained block", "ssor", "ic0"};

// Iterations of a component that all rows share equally in.
double iterations_of(const Components& components, const std::vector<ComponentSolve>& solves) {
    double sum = 0, rows = 0;
    for (std::size_t c = 0; c < solves.size(); ++c) {
        sum += static_cast<double>(solves[c].iterations) * components.size(c);
        rows += components.size(c);
    }
    return rows > 0 ? sum / rows : 0;
}

}  // namespace

std::vector<PreconditionerPoint> study_preconditioners(const Scene& scene, std::span<const int> sides,
                                                       double from, int systems,
                                                       std::span<const Preconditioner> kinds,
                                                       const std::function<bool()>& keep_on) {
    std::vector<PreconditionerPoint> points;
    for (const int side : sides) {
        Scene refined = scene;
        refined.cloths.front().particles = {side, side};
        Simulation simulation = start_simulation(refined);
        simulation.options.measure = false;
        const auto before = static_cast<int>(std::lround(from / refined.solver.step));
        std::vector<PreconditionerPoint> mesh;
        for (const Preconditioner kind : kinds) mesh.push_back({kind, simulation.model.size(), 0, 0, 0});
        SolveWorkspace solve_ws;
        std::vector<ComponentSolve> solves;
        for (int k = 0; k < before + systems; ++k) {
            if (!keep_on()) return points;
            const std::vector<Vec3> guess = simulation.state.dv;
            const StepReport report = step(simulation.model, simulation.options, refined.solver.step,
                                           simulation.state, simulation.ws);
            if (k < before || !simulation.ws.coupled) continue;
            for (PreconditionerPoint& point : mesh) {
                SolveOptions options = simulation.options.solve;
                options.preconditioner = point.preconditioner;
                solve(simulation.ws.system, simulation.ws.components, simulation.ws.constraints, guess,
                      options, solve_ws, solves);
                const double n = static_cast<double>(simulation.model.size());
                point.iterations += iterations_of(simulation.ws.components, solves) / systems;
                point.constrained += report.constrained / n / systems;
                point.partly += report.partly / n / systems;
            }
        }
        points.insert(points.end(), mesh.begin(), mesh.end());
    }
    return points;
}

Plot preconditioner_plot(std::span<const PreconditionerPoint> points) {
    Plot plot;
    plot.title = "CG iterations with each preconditioner, constrained cloth";
    plot.x = {"particles", true, {}, {}, {}};
    plot.y = {"iterations per solve", true, {}, {}, {}};
    for (const PreconditionerPoint& point : points) {
        const std::string label = names[static_cast<int>(point.preconditioner)];
        PlotSeries* series = nullptr;
        for (PlotSeries& s : plot.series) {
            if (s.label == label) series = &s;
        }
        if (!series) {
            plot.series.emplace_back();
            series = &plot.series.back();
            series->label = label;
        }
        PlotPoint plotted;
        plotted.x = static_cast<double>(point.particles);
        plotted.y = point.iterations;
        series->points.push_back(plotted);
    }
    return plot;
}

}  // namespace unravel
