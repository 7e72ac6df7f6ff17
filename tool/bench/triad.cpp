#include "tool/bench/triad.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "sim/rows/versions.hpp"
#include "tool/base/spread.hpp"

namespace unravel::tool {

namespace {

// Elements that one task takes at a time: as many as a solver's task would.
constexpr std::size_t band = std::size_t{1} << 14;
constexpr int passes = 7;

// Compiled for the machine's widest vectors, as the kernels are that are compared with it.
UNRAVEL_VERSIONS void pass_over(double* __restrict a, const double* __restrict b, const double* __restrict c,
                                std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 3.0 * c[i];
}

}  // namespace

double triad(std::size_t bytes, int threads) {
    const std::size_t n = std::max(bytes / 24, band);
    std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
    const std::size_t bands = (n + band - 1) / band;
    // A pass over small arrays is too short for the clock.
    const std::size_t repeats = std::max<std::size_t>(1, (std::size_t{64} << 20) / bytes);
    std::vector<double> rates;
    tbb::task_arena arena(threads);
    arena.execute([&] {
        for (int pass = 0; pass <= passes; ++pass) {
            const auto start = std::chrono::steady_clock::now();
            for (std::size_t k = 0; k < repeats; ++k) {
                tbb::parallel_for(
                    std::size_t{0}, bands,
                    [&](std::size_t at) {
                        const std::size_t begin = at * band;
                        pass_over(a.data() + begin, b.data() + begin, c.data() + begin,
                                  std::min(band, n - begin));
                    },
                    tbb::static_partitioner());
                std::swap(a, b);
            }
            const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
            if (pass > 0) rates.push_back(24e-9 * static_cast<double>(n * repeats) / time.count());
        }
    });
    return spread_of(std::move(rates)).median;
}

}  // namespace unravel::tool
