#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/grid_springs.hpp"

namespace unravel::sim {

/// Where a particle's springs are, and who is at their other ends: by lists, or, for the stretch and shear
/// springs of cloths that are all grids, by stencil.
struct Adjacency {
    struct Entry {
        std::uint32_t spring, other;
    };
    std::vector<std::uint32_t> start;  ///< (particles + 1) particle p's are entries [start[p], start[p+1])
    std::vector<Entry> entries;        ///< (2 × springs) each particle's sorted by spring
    std::vector<GridSprings> grids;    ///< sorted by particle; none: by lists

    std::size_t bytes() const {
        return start.size() * sizeof(std::uint32_t) + entries.size() * sizeof(Entry) +
               grids.size() * sizeof(GridSprings);
    }
    /// Calls f(spring, other) for each spring of particle p, sorted by spring.
    template <typename F>
    void each(std::uint32_t p, const F& f) const {
        if (!grids.empty()) return each_by_stencil(p, f);
        for (std::uint32_t k = start[p]; k < start[p + 1]; ++k) f(entries[k].spring, entries[k].other);
    }

private:
    template <typename F>
    void each_by_stencil(std::uint32_t p, const F& f) const {
        std::size_t g = 0;
        while (g + 1 < grids.size() && grids[g + 1].particle <= p) ++g;
        const GridSprings& grid = grids[g];
        const std::uint32_t node = p - grid.particle;
        if (node >= grid.count()) return;
        for (const SpringRows* rows : {&grid.u, &grid.v, &grid.diagonal, &grid.anti}) {
            // The one that ends here, and the one that begins here; where a tube closes, the other way round.
            std::array<Entry, 2> found;
            std::size_t count = 0;
            if (find_spring(grid, *rows, node, rows->to, rows->from, found[count])) ++count;
            if (find_spring(grid, *rows, node, rows->from, rows->to, found[count])) ++count;
            if (count == 2 && found[0].spring > found[1].spring) std::swap(found[0], found[1]);
            for (std::size_t k = 0; k < count; ++k) f(found[k].spring, found[k].other);
        }
    }
    // The spring of which a node is the end `here`.
    static bool find_spring(const GridSprings& grid, const SpringRows& rows, std::uint32_t node,
                            const std::array<std::uint32_t, 2>& here,
                            const std::array<std::uint32_t, 2>& there, Entry& out) {
        std::uint32_t i = node % grid.nu, j = node / grid.nu;
        if (grid.tube && i < here[0]) i += grid.nu;
        if (i < here[0] || j < here[1]) return false;
        i -= here[0];
        j -= here[1];
        if (i >= rows.per_row || j >= rows.rows) return false;
        out = {rows.at(i, j), grid.at(i + there[0], j + there[1])};
        return true;
    }
};

/// By lists: of the graph with edges (i[s], j[s]).
Adjacency adjacency_of(std::size_t particles, std::span<const std::uint32_t> i,
                       std::span<const std::uint32_t> j);

/// By stencil, of the stretch and shear springs of grids that hold every particle that has any.
inline Adjacency adjacency_of(std::vector<GridSprings> grids) {
    Adjacency adjacency;
    adjacency.grids = std::move(grids);
    return adjacency;
}

}  // namespace unravel::sim
