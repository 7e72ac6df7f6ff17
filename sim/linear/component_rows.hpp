#pragma once

#include <cstdint>

#include "sim/linear/solve.hpp"

namespace unravel::sim {

/// The rows of one component and the vectors over them.
struct ComponentRows {
    const System& A;
    const Components& components;
    const Constraints& constraints;
    SolveWorkspace& ws;
    std::size_t component;
    std::uint32_t begin, end;
    double* partials;  ///< one per chunk of these rows, nobody else's

    std::uint32_t count() const { return end - begin; }

    /// Sum over rows of f(row), in chunk order.
    template <typename F>
    double sum(const F& f) const {
        const auto over = [&](std::uint32_t first, std::uint32_t last) {
            double partial = 0;
            for (std::uint32_t row = first; row < last; ++row) partial += f(row);
            return partial;
        };
        if (count() <= chunk_size) return over(begin, end);
        parallel_chunks(count(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
            partials[chunk] =
                over(begin + static_cast<std::uint32_t>(first), begin + static_cast<std::uint32_t>(last));
        });
        double total = 0;
        for (std::size_t chunk = 0; chunk < chunk_count(count()); ++chunk) total += partials[chunk];
        return total;
    }
    template <typename F>
    void each(const F& f) const {
        parallel_each(count(), [&](std::size_t k) { f(begin + static_cast<std::uint32_t>(k)); });
    }
    /// S y of one row's y.
    Vec3 filtered(std::uint32_t row, const Vec3& y) const {
        const Constraint* const c = ws.constraint[row];
        return c ? Vec3(c->S * y) : y;
    }
};

}  // namespace unravel::sim
