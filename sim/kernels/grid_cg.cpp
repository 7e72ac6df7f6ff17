#include "sim/kernels/grid_cg.hpp"

#include <algorithm>
#include <cmath>

#include "sim/linear/conjugate_gradients.hpp"

namespace unravel::sim {

namespace {

// The recursive residual aims a little lower than the tolerance, so that the true one seldom misses it.
constexpr double aim = 0.95;
// A restart that gains less than this factor on ‖r‖² has met the end of single precision.
constexpr double least_gain = 0.5;

// CG's problem on a grid: two fused sweeps per iteration.
struct GridCg {
    GridSystem& system;
    GridCgWorkspace& ws;
    const StencilGrid& g;
    const StencilKernels& kernels = stencil_kernels();
    RowBands bands;
    bool multigrid = false;  // or blocks, which are applied as the residual is measured
    double measured = 0;
    int side = 0;  // of the two directions, the current one

    GridCg(GridSystem& s, GridCgWorkspace& w) : system(s), ws(w), g(s.grid), bands(s.grid) {
        // What lies outside the grid stays zero from one solve to the next.
        if (ws.nu == g.nu && ws.nv == g.nv) return;
        ws.nu = g.nu;
        ws.nv = g.nv;
        for (std::vector<float>* field : {&ws.r, &ws.z, &ws.q, &ws.d, &ws.p[0], &ws.p[1]})
            field->assign(s.field(3), 0.0f);
        ws.dots.resize(static_cast<std::size_t>(g.nv));
    }

    // Runs f(first row, last row) over all bands and returns the sum of what it left in ws.dots.
    template <typename F>
    double sweep(const F& f) {
        if (bands.count == 1) {
            f(0, g.nv);
        } else {
            tbb::parallel_for(0, bands.count, [&](int band) { f(bands.begin(band), bands.end(band)); });
        }
        double sum = 0;
        for (const double row : ws.dots) sum += row;
        return sum;
    }
    template <typename T>
    T* scratch() const {
        thread_local std::vector<T> memory;
        const std::size_t size = sweep_scratch_rows * static_cast<std::size_t>(g.pitch);
        if (memory.size() < size) memory.resize(size);
        return memory.data();
    }
    std::ptrdiff_t row(int j, int numbers) const {
        return static_cast<std::ptrdiff_t>(j) * numbers * g.pitch + StencilGrid::margin;
    }

    // ‖b‖² in the norm of P.
    double right_side() {
        return sweep([&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                const double *const x = system.b.data() + row(j, 3), *const y = x + g.pitch,
                                    *const z = y + g.pitch;
                const float* const P = system.P.data() + row(j, 6);
                double sum = 0;
                for (int i = 0; i < g.nu; ++i) {
                    const auto n = [&](int k) { return static_cast<double>(P[k * g.pitch + i]); };
                    sum += x[i] * (n(0) * x[i] + 2 * (n(1) * y[i] + n(2) * z[i])) +
                           y[i] * (n(3) * y[i] + 2 * n(4) * z[i]) + n(5) * z[i] * z[i];
                }
                ws.dots[static_cast<std::size_t>(j)] = sum;
            }
        });
    }

    // r = b − A x; returns ‖r‖².
    double true_residual() {
        if (g.tube) {
            for (int j = 0; j < g.nv; ++j) {
                for (int c = 0; c < 3; ++c) {
                    double* const x = system.x.data() + row(j, 3) + c * g.pitch;
                    x[-1] = x[g.nu - 1];
                    x[g.nu] = x[0];
                }
            }
        }
        const double* b = system.b.data();
        if (g.bends) {
            ws.bent.resize(system.field(3));
            sweep([&](int begin, int end) {
                kernels.bending.take_in_double(g, begin, end, b, system.x.data(), ws.bent.data(),
                                               scratch<double>());
            });
            b = ws.bent.data();
        }
        return sweep([&](int begin, int end) {
            kernels.sweep.residual(g, begin, end, b, system.x.data(), system.P.data(), ws.r.data(),
                                   ws.dots.data(), scratch<double>());
        });
    }

    // Begins a series of iterations; ‖r‖², of which `residual` is the true one.
    double begin(double residual) {
        // A sweep that advances by nothing makes z = P r.
        return multigrid ? residual : measure(0);
    }
    double precondition() {
        if (!multigrid) return measured;
        ws.multigrid.apply(ws.r.data(), ws.z.data());
        return product();
    }
    double multiply(double beta) {
        const float *const z = ws.z.data(), *const p = ws.p[static_cast<std::size_t>(side)].data();
        side ^= 1;
        float* const p_next = ws.p[static_cast<std::size_t>(side)].data();
        const double of_springs = sweep([&](int begin, int end) {
            kernels.sweep.direction(g, begin, end, static_cast<float>(beta), z, p, p_next, ws.q.data(),
                                    ws.dots.data(), scratch<float>());
        });
        if (!g.bends) return of_springs;
        return sweep([&](int begin, int end) {
            kernels.bending.add(g, begin, end, p_next, ws.q.data(), ws.dots.data(), scratch<float>());
        });
    }
    double measure(double alpha) {
        measured = sweep([&](int begin, int end) {
            kernels.sweep.advance(g, begin, end, static_cast<float>(alpha),
                                  ws.p[static_cast<std::size_t>(side)].data(), ws.q.data(), ws.d.data(),
                                  ws.r.data(), system.P.data(), multigrid ? nullptr : ws.z.data(),
                                  ws.dots.data());
        });
        return measured;
    }

    // r·z
    double product() {
        return sweep([&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                const float *const r = ws.r.data() + row(j, 3), *const z = ws.z.data() + row(j, 3);
                double lanes[8] = {};
                for (int c = 0; c < 3; ++c) {
                    const float *const a = r + c * g.pitch, *const b = z + c * g.pitch;
                    for (int i = 0; i < g.columns(); i += 8)
                        for (int k = 0; k < 8; ++k) lanes[k] += static_cast<double>(a[i + k] * b[i + k]);
                }
                double sum = 0;
                for (const double lane : lanes) sum += lane;
                ws.dots[static_cast<std::size_t>(j)] = sum;
            }
        });
    }

    // x += d, d = 0
    void take_correction() {
        sweep([&](int begin, int end) {
            for (std::ptrdiff_t k = row(begin, 3) - StencilGrid::margin;
                 k < row(end, 3) - StencilGrid::margin; ++k) {
                const auto n = static_cast<std::size_t>(k);
                system.x[n] += static_cast<double>(ws.d[n]);
                ws.d[n] = 0;
            }
        });
    }
};

}  // namespace

bool solve_on_grid(GridSystem& system, bool multigrid, std::uint32_t patience, const SolveOptions& options,
                   GridCgWorkspace& ws, ComponentSolve& out) {
    GridCg cg(system, ws);
    out = {};
    out.because = options.preconditioner != Preconditioner::automatic ? SolveReason::asked
                  : multigrid                                         ? SolveReason::many_expected
                                                                      : SolveReason::on_grid;
    const double target = options.tolerance * options.tolerance * cg.right_side();
    double residual = cg.true_residual();
    out.rvm = system.rows;
    const auto limit = static_cast<std::uint32_t>(options.max_iterations);
    cg.multigrid = multigrid;
    if (multigrid && residual > target) ws.multigrid.build(system);
    std::uint32_t until = std::min(limit, patience);

    while (residual > target && out.iterations < limit) {
        const std::uint32_t first = out.iterations;
        conjugate_gradients(cg, cg.begin(residual), aim * target, until, out.iterations, options.stop);
        out.rvm += static_cast<std::uint64_t>(out.iterations - first) * system.rows;
        cg.take_correction();
        const double before = residual;
        residual = cg.true_residual();
        out.rvm += system.rows;
        if (residual <= target) break;
        if (!std::isfinite(residual)) return false;
        const bool stalled = !(residual < least_gain * before);
        if (until < limit && (out.iterations >= until || (stalled && cg.multigrid))) {
            until = limit;
            cg.multigrid = !cg.multigrid;
            out.because = SolveReason::took_over;
            if (cg.multigrid) ws.multigrid.build(system);
        } else if (stalled) {
            return false;
        }
    }
    out.by = cg.multigrid ? SolvedBy::multigrid : SolvedBy::grid;
    out.converged = residual <= target;
    out.residual = target > 0 ? options.tolerance * std::sqrt(std::max(residual, 0.0) / target) : 0.0;
    return std::isfinite(residual);
}

}  // namespace unravel::sim
