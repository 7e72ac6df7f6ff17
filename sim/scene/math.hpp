#pragma once

// Vectors, matrices and the loops over them. Every sum in the simulator runs in a fixed order that depends on
// sizes alone, never on threads: parallel_chunks() cuts a range the same way however many threads there are,
// and whoever sums over it adds one partial per chunk, in chunk order.

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace unravel::sim {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Leaves new elements as the allocator gives them: memory that nobody writes is then none that the machine
/// gives away. Only for what is always written before it is read.
template <typename T>
struct Untouched : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = Untouched<U>;
    };
    template <typename U>
    void construct(U* p) noexcept {
        ::new (static_cast<void*>(p)) U;
    }
    template <typename U, typename... Args>
    void construct(U* p, Args&&... args) {
        ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
    }
};
template <typename T>
using UntouchedVector = std::vector<T, Untouched<T>>;

/// Rows, particles or springs handled by one task. Large enough to hide a task's cost, small enough for two
/// cores to share 10⁴ of them evenly.
inline constexpr std::size_t chunk_size = 1024;

inline std::size_t chunk_count(std::size_t size) {
    return (size + chunk_size - 1) / chunk_size;
}

/// Calls f(chunk, begin, end) for each chunk of [0, size), in parallel.
template <typename F>
void parallel_chunks(std::size_t size, const F& f) {
    const std::size_t chunks = chunk_count(size);
    const auto run = [&](std::size_t chunk) {
        const std::size_t begin = chunk * chunk_size;
        f(chunk, begin, begin + chunk_size < size ? begin + chunk_size : size);
    };
    if (chunks == 1) return run(0);
    tbb::parallel_for(std::size_t{0}, chunks, run);
}

/// Calls f(i) for each i of [0, size), in parallel.
template <typename F>
void parallel_each(std::size_t size, const F& f) {
    parallel_chunks(size, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) f(i);
    });
}

/// Sum over [0, size) of f(begin, end), one partial per chunk, added in chunk order. `partials` is scratch
/// that keeps its memory between calls.
template <typename F>
double parallel_sum(std::size_t size, std::vector<double>& partials, const F& f) {
    partials.assign(chunk_count(size), 0.0);
    parallel_chunks(size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        partials[chunk] = f(begin, end);
    });
    double sum = 0;
    for (const double partial : partials) sum += partial;
    return sum;
}

}  // namespace unravel::sim
