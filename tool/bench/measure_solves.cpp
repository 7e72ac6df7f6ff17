#include "tool/bench/measure_solves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool/bench/peers.hpp"

namespace unravel::tool {

namespace {

// Factors of larger systems fill tens of gigabytes.
constexpr double most_particles_direct = 250'000;
// Iterations between which the cost of one is measured, set-up being in both; of multigrid cycles.
constexpr int few_iterations = 8, many_iterations = 32, few_cycles = 1, many_cycles = 4;

// Share of what is left for solves that is kept for them.
constexpr double iterations_share = 0.25;

constexpr const char* eigen_cg = "Eigen CG, diagonal";

// A way to solve, ours or not.
struct Way {
    std::string name;
    int threads = 1;
    bool ours = true;
    Preconditioner preconditioner = Preconditioner::automatic;
    bool direct = false;
    double growth = 1.6;  ///< of its time with n, at most
    double first = 0;     ///< s for 2,500 particles, where no smaller problem was measured
};

std::vector<Way> ways_of(int threads) {
    std::vector<Way> ways;
    const std::pair<const char*, Preconditioner> on_all[] = {
        {"auto", Preconditioner::automatic},
        {"multigrid", Preconditioner::multigrid},
        {"stencil-block", Preconditioner::stencil_block},
        {"constrained-block", Preconditioner::constrained_block}};
    const std::pair<const char*, Preconditioner> on_one[] = {{"block", Preconditioner::block},
                                                             {"diagonal", Preconditioner::diagonal},
                                                             {"none", Preconditioner::none},
                                                             {"ssor", Preconditioner::ssor},
                                                             {"ic0", Preconditioner::ic0}};
    for (const auto& [name, kind] : on_all) {
        ways.push_back({name, 1, true, kind});
        if (threads > 1) ways.push_back({name, threads, true, kind});
    }
    for (const auto& [name, kind] : on_one) ways.push_back({name, 1, true, kind});
    ways.push_back({eigen_cg, 1, false});
    ways.push_back({"CHOLMOD", 1, false, Preconditioner::none, true, 1.4, 0.025});
    ways.push_back({"Eigen LDLT", 1, false, Preconditioner::none, true, 1.9, 0.03});
    return ways;
}

double expected(const SpeedBench& smaller, const Way& way, double particles) {
    for (auto size = smaller.sizes.rbegin(); size != smaller.sizes.rend(); ++size) {
        if (const SolveRecord* s = size->solve_of(way.name, way.threads))
            return s->seconds.median * std::pow(particles / size->particles, way.growth);
    }
    return way.first * std::pow(particles / 2500, way.growth);
}

// Bytes that an iteration reads and writes at least, per block row, if it finds nothing in a cache.
double bytes_on_grid(const GridSystem& system) {
    // Couplings, mass; direction: z, p → p', q; advance: p', q, x, r, P → x, r, z. Floats.
    return 4.0 * ((system.grid.diagonals ? 16 : 8) + 1 + 12 + 3 + 3 + 3 + 3 + 6 + 3 + 3 + 3);
}
double bytes_on_rows(double blocks_per_row) {
    // A, its diagonal, p → q; p, q, x, r, P → x, r, q; q, p → p. Doubles.
    return sizeof(System::Entry) * blocks_per_row + 4 + 8.0 * (9 + 6 + 12 + 9 + 9 + 9) + 8;
}
double bytes_of_eigen(double blocks_per_row) {
    // A with its own block by scalars; p → t; p, t, x, r → x, r; r, D → z; z, r; z, p → p.
    return 12.0 * 9 * (blocks_per_row + 1) + 12 + 8.0 * (6 + 18 + 9 + 6 + 9);
}

class Solves {
public:
    Solves(MeasuredProblem& problem, const SpeedPlan& plan, const SpeedBench& smaller,
           const Allowance& allowance, SizeRecord& record)
        : problem_(problem),
          plan_(plan),
          smaller_(smaller),
          allowance_(allowance),
          record_(record),
          options_(problem.simulation().options.solve),
          folded_(problem.folded()),
          ways_(ways_of(plan.threads)) {}

    void run() {
        for (const Way& way : ways_) {
            SolveRecord solve;
            solve.name = way.name;
            solve.threads = way.threads;
            solve.ours = way.ours;
            solve.left_out = why_not(way);
            record_.solves.push_back(std::move(solve));
        }
        std::vector<std::vector<double>> seconds(ways_.size()), set_up(ways_.size());
        const double kept = iterations_share * allowance_.left();
        for (int run = 0; run < plan_.repeats; ++run) {
            for (std::size_t k = 0; k < ways_.size(); ++k) {
                SolveRecord& solve = record_.solves[k];
                if (!solve.left_out.empty()) continue;
                const double each =
                    run > 0 ? seconds[k].front() : expected(smaller_, ways_[k], record_.particles);
                if (2 * each > allowance_.left() - kept) {
                    if (run == 0) solve.left_out = fmt::format("about {:.3g} s: beyond the budget", each);
                    continue;
                }
                once(ways_[k], run, solve, seconds[k], set_up[k]);
            }
        }
        for (std::size_t k = 0; k < ways_.size(); ++k) {
            if (seconds[k].empty()) continue;
            record_.solves[k].seconds = spread_of(seconds[k]);
            record_.solves[k].set_up = spread_of(set_up[k]).median;
        }
        for (std::size_t k = 0; k < ways_.size(); ++k) cost_of_iterations(ways_[k], record_.solves[k]);
    }

private:
    std::string why_not(const Way& way) const {
        if (way.name == "CHOLMOD" && !smaller_.cholmod_missing.empty()) return smaller_.cholmod_missing;
        if (way.direct && record_.particles > most_particles_direct)
            return "its factors need too much memory";
        return "";
    }

    SolveOptions options_of(const Way& way) const {
        SolveOptions options = options_;
        options.preconditioner = way.preconditioner;
        return options;
    }

    void once(const Way& way, int run, SolveRecord& solve, std::vector<double>& seconds,
              std::vector<double>& set_up) {
        if (way.ours) {
            // The first makes its memory.
            if (run == 0) problem_.solve(options_of(way), way.threads);
            const MeasuredProblem::Solve solved = problem_.solve(options_of(way), way.threads);
            seconds.push_back(solved.seconds);
            set_up.push_back(solved.set_up);
            solve.iterations = solved.iterations;
            if (run == 0) solve.residual = folded_.residual(folded_.unknowns(problem_.solution()));
            return;
        }
        const std::optional<PeerSolve> solved =
            way.name == "CHOLMOD" ? solve_by_cholmod(folded_)
            : way.direct          ? solve_by_eigen_ldlt(folded_)
                                  : solve_by_eigen_cg(folded_, options_.tolerance, options_.max_iterations);
        if (!solved) {
            solve.left_out = "the factorisation failed";
            return;
        }
        seconds.push_back(solved->seconds);
        set_up.push_back(solved->set_up);
        solve.iterations = solved->iterations;
        if (run == 0) solve.residual = folded_.residual(solved->y);
    }

    // From the difference between many iterations and few, far below the tolerance; per row that they
    // multiply.
    void cost_of_iterations(const Way& way, SolveRecord& solve) {
        if (way.direct || way.preconditioner == Preconditioner::automatic) {
            if (way.ours || way.direct) return;
        }
        const bool cycles = way.preconditioner == Preconditioner::multigrid;
        const int few = cycles ? few_cycles : few_iterations, many = cycles ? many_cycles : many_iterations;
        const auto [rows, entries] = problem_.blocks();
        if (solve.seconds.runs == 0 || rows == 0) return;
        std::vector<double> differences;
        double multiplies = 0;
        for (int run = 0; run <= plan_.repeats; ++run) {
            double difference = 0;
            multiplies = 0;
            for (const int most : {few, many}) {
                const double sign = most == many ? 1 : -1;
                if (way.ours) {
                    SolveOptions options = options_of(way);
                    options.tolerance = grid_cg_tolerance;
                    options.max_iterations = most;
                    const MeasuredProblem::Solve solved = problem_.solve(options, way.threads);
                    difference += sign * (solved.seconds - solved.set_up);
                    multiplies += sign * static_cast<double>(solved.rvm);
                } else {
                    const PeerSolve solved = solve_by_eigen_cg(folded_, 1e-12, most);
                    difference += sign * (solved.seconds - solved.set_up);
                    multiplies += sign * rows * solved.iterations;
                }
            }
            const bool last = allowance_.left() < 0;
            if (run > 0 || last) differences.push_back(difference);
            if (last) break;
        }
        if (differences.empty() || !(multiplies > 0)) return;
        const double cost = spread_of(differences).median / multiplies;
        if (!(cost > 0)) return;
        solve.row_iteration = cost;
        if (cycles) return;
        const GridSystem* grid =
            way.preconditioner == Preconditioner::stencil_block ? problem_.grid() : nullptr;
        if (!way.ours) {
            solve.row_bytes = bytes_of_eigen(entries / rows);
        } else if (grid) {
            solve.row_bytes = bytes_on_grid(*grid);
        } else if (way.preconditioner == Preconditioner::constrained_block) {
            solve.row_bytes = bytes_on_rows(entries / rows);
        }
    }

    MeasuredProblem& problem_;
    const SpeedPlan& plan_;
    const SpeedBench& smaller_;
    const Allowance& allowance_;
    SizeRecord& record_;
    SolveOptions options_;
    FoldedSystem folded_;
    std::vector<Way> ways_;
};

}  // namespace

void measure_solves(MeasuredProblem& problem, const SpeedPlan& plan, const SpeedBench& smaller,
                    const Allowance& allowance, SizeRecord& record) {
    Solves(problem, plan, smaller, allowance, record).run();
}

}  // namespace unravel::tool
