#include "sim/kernels/line_multigrid.hpp"

#include <algorithm>

namespace unravel::sim {

namespace {

// A grid of no more nodes is solved by its lines alone.
constexpr int coarsest_grid_nodes = 32;
// Sweeps of the lines there, down and up.
constexpr int coarsest_grid_sweeps = 2;
// Columns that one task takes along v.
constexpr int strip = 64;

std::size_t field(const StencilGrid& g, int numbers) {
    return static_cast<std::size_t>((g.nv + 7) / 8 * 8) * static_cast<std::size_t>(numbers) *
               static_cast<std::size_t>(g.pitch) +
           64;
}

// One level's grids are small enough for one task from here on.
bool is_small(const StencilGrid& g) {
    return g.nu * g.nv <= 2048;
}

template <typename F>
void over_bands(const StencilGrid& g, const F& f) {
    const RowBands bands(g);
    if (bands.count == 1) return f(0, g.nv);
    tbb::parallel_for(0, bands.count, [&](int band) { f(bands.begin(band), bands.end(band)); });
}

// Scratch of the thread that runs a task.
float* scratch(std::size_t floats) {
    thread_local std::vector<float> memory;
    if (memory.size() < floats) memory.resize(floats);
    return memory.data();
}

}  // namespace

void LineMultigrid::set_up(Level& level, int kind) {
    const StencilGrid& g = level.grid;
    const StencilKernels& kernels = stencil_kernels();
    level.lines_v.resize(field(g, 6));
    const std::size_t line = 8 * (kind == 0 ? 10 : 12) * static_cast<std::size_t>(g.columns());
    const int blocks = (g.nv + 7) / 8;
    level.lines_u.resize(line * static_cast<std::size_t>(blocks));
    level.t.resize(field(g, 3));
    // What the finest level takes and gives is the caller's.
    for (std::vector<float>* vector : {&level.r, &level.z}) vector->resize(kind == 0 ? 0 : field(g, 3));
    const int strips = (g.columns() + strip - 1) / strip;
    const auto along_v = [&](int k) {
        kernels.line.factor_v[kind](g, k * strip, std::min((k + 1) * strip, g.columns()), level.diagonal,
                                    level.lines_v.data());
    };
    const auto along_u = [&](int k) {
        kernels.line.factor_u[kind](g, k, level.diagonal,
                                    level.lines_u.data() + line * static_cast<std::size_t>(k));
    };
    const auto both = [&](int k) { k < strips ? along_v(k) : along_u(k - strips); };
    if (is_small(g)) {
        for (int k = 0; k < strips + blocks; ++k) both(k);
    } else {
        tbb::parallel_for(0, strips + blocks, both);
    }
}

void LineMultigrid::build(const GridSystem& system) {
    system_ = &system;
    const StencilKernels& kernels = stencil_kernels();
    if (levels_.empty()) levels_.emplace_back();
    levels_[0].grid = system.grid;
    levels_[0].diagonal = system.D.data();
    if (system.grid.bends) {
        levels_[0].D = system.D;
        levels_[0].diagonal = levels_[0].D.data();
        over_bands(system.grid, [&](int begin, int end) {
            kernels.bending.diagonal[1](system.grid, begin, end, levels_[0].D.data());
        });
    }
    set_up(levels_[0], 0);
    depth_ = 1;
    const float* active = system.active.data();
    while (levels_[depth_ - 1].grid.nu * levels_[depth_ - 1].grid.nv > coarsest_grid_nodes) {
        if (levels_.size() == depth_) levels_.emplace_back();
        Level& fine = levels_[depth_ - 1];
        Level& coarse = levels_[depth_];
        const int kind = depth_ == 1 ? 0 : 1;
        StencilGrid& g = coarse.grid;
        const StencilGrid before = g;
        g = {};
        g.nu = (fine.grid.nu + 1) / 2;
        g.nv = (fine.grid.nv + 1) / 2;
        g.pitch = g.columns() + 2 * StencilGrid::margin;
        g.tube = fine.grid.tube;
        g.diagonals = fine.grid.diagonals;
        if (before.nu != g.nu || before.nv != g.nv || before.tube != g.tube) {
            coarse.couplings.assign(field(g, 24), 0.0f);
            coarse.self.assign(field(g, 6), 0.0f);
            coarse.active.assign(field(g, 1), 0.0f);
            coarse.D.assign(field(g, 6), 0.0f);
            coarse.slot.assign(field(g, 1), masked_slot);
            for (std::vector<float>* vector : {&coarse.r, &coarse.z, &coarse.t})
                vector->assign(field(g, 3), 0.0f);
        }
        g.couplings = coarse.couplings.data();
        g.self = coarse.self.data();
        g.slot = coarse.slot.data();
        over_bands(g, [&](int begin, int end) {
            kernels.coarsening.coarsen[kind](fine.grid, fine.diagonal, active, g, begin, end,
                                             coarse.couplings.data(), coarse.self.data(), coarse.slot.data(),
                                             coarse.active.data());
        });
        if (fine.grid.bends) {
            coarse.bends.assign(field(g, 3), 0.0f);
            over_bands(g, [&](int begin, int end) {
                kernels.bending.coarsen(fine.grid, g, begin, end, coarse.bends.data(), coarse.self.data());
            });
            g.bends = coarse.bends.data();
        }
        over_bands(g, [&](int begin, int end) {
            kernels.sweep.diagonal[1](g, begin, end, coarse.D.data());
            for (const auto& diagonal : kernels.bending.diagonal)
                if (g.bends) diagonal(g, begin, end, coarse.D.data());
        });
        coarse.diagonal = coarse.D.data();
        set_up(coarse, 1);
        active = coarse.active.data();
        ++depth_;
    }
}

void LineMultigrid::relax_u(Level& level, int kind, const float* t, float* z, bool add) {
    const StencilGrid& g = level.grid;
    const std::size_t line = 8 * (kind == 0 ? 10 : 12) * static_cast<std::size_t>(g.columns());
    const int blocks = (g.nv + 7) / 8;
    const auto solve = [&](int k) {
        stencil_kernels().line.solve_u[kind](g, k, level.lines_u.data() + line * static_cast<std::size_t>(k),
                                             t, z, add, scratch(24 * static_cast<std::size_t>(g.columns())));
    };
    if (is_small(g)) {
        for (int k = 0; k < blocks; ++k) solve(k);
    } else {
        tbb::parallel_for(0, blocks, solve);
    }
}

void LineMultigrid::relax_v(Level& level, int kind, float* z) {
    const StencilGrid& g = level.grid;
    // Two tasks at least, where there are columns for them.
    const int width = std::min(strip, std::max(8, (g.columns() / 2 + 7) / 8 * 8));
    const int strips = (g.columns() + width - 1) / width;
    const auto solve = [&](int k) {
        stencil_kernels().line.solve_v[kind](g, k * width, std::min((k + 1) * width, g.columns()),
                                             level.lines_v.data(), level.t.data(), z, true);
    };
    if (is_small(g)) {
        for (int k = 0; k < strips; ++k) solve(k);
    } else {
        tbb::parallel_for(0, strips, solve);
    }
}

void LineMultigrid::find_defect(Level& level, int kind, const float* r, float* z) {
    const StencilGrid& g = level.grid;
    const StencilKernels& kernels = stencil_kernels();
    if (g.tube) over_bands(g, [&](int begin, int end) { kernels.transfer.close_rings(g, begin, end, z); });
    over_bands(g, [&](int begin, int end) {
        kernels.sweep.defect[kind](g, begin, end, r, z, level.t.data(),
                                   scratch(sweep_scratch_rows * static_cast<std::size_t>(g.pitch)));
    });
    if (!g.bends) return;
    over_bands(g, [&](int begin, int end) {
        kernels.bending.take(g, begin, end, z, level.t.data(),
                             scratch(sweep_scratch_rows * static_cast<std::size_t>(g.pitch)));
    });
}

void LineMultigrid::cycle(std::size_t depth, const float* r, float* z) {
    Level& level = levels_[depth];
    const int kind = depth == 0 ? 0 : 1;
    const StencilGrid& g = level.grid;
    const StencilKernels& kernels = stencil_kernels();
    relax_u(level, kind, r, z, false);
    const bool coarsest = depth + 1 == depth_;
    find_defect(level, kind, r, z);
    relax_v(level, kind, z);
    for (int k = 1; coarsest && k < coarsest_grid_sweeps; ++k) {
        find_defect(level, kind, r, z);
        relax_u(level, kind, level.t.data(), z, true);
        find_defect(level, kind, r, z);
        relax_v(level, kind, z);
    }
    if (!coarsest) {
        Level& coarse = levels_[depth + 1];
        const std::size_t floats = 2 * static_cast<std::size_t>(g.pitch) + 64;
        find_defect(level, kind, r, z);
        over_bands(coarse.grid, [&](int begin, int end) {
            kernels.transfer.restrict_to(g, coarse.grid, begin, end, level.t.data(), coarse.r.data(),
                                         scratch(floats));
        });
        cycle(depth + 1, coarse.r.data(), coarse.z.data());
        over_bands(g, [&](int begin, int end) {
            kernels.transfer.prolong_add(g, coarse.grid, begin, end, coarse.z.data(), z, scratch(floats));
        });
    }
    for (int k = 0; k < (coarsest ? coarsest_grid_sweeps : 1); ++k) {
        find_defect(level, kind, r, z);
        relax_v(level, kind, z);
        find_defect(level, kind, r, z);
        relax_u(level, kind, level.t.data(), z, true);
    }
}

void LineMultigrid::apply(const float* r, float* z) {
    cycle(0, r, z);
}

}  // namespace unravel::sim
