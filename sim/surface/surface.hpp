#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A row of lists, one after the other: those of k are in list[start[k] … start[k + 1]).
struct Lists {
    std::vector<std::uint32_t> start, list;
    std::span<const std::uint32_t> of(std::uint32_t k) const {
        return std::span(list).subspan(start[k], start[k + 1] - start[k]);
    }
};

/// What of cloths can be touched: triangles, their edges (each once), and edges that belong to no triangle
/// (ribbons one particle wide). Corners are particles. Built once, and only where a scene asks for contact
/// between surfaces or for crossings to be counted.
struct Surface {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::array<std::uint32_t, 3>>
        triangles;                                    ///< counter-clockwise from the front; cloth by cloth
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< a < b, sorted
    std::vector<std::array<std::uint32_t, 2>> sides;  ///< (edges) triangles at it, or none
    std::vector<std::uint32_t> vertices;              ///< particles that edges end at, sorted
    Lists triangles_at, edges_at;                     ///< of each particle
    std::vector<std::uint32_t> cloth;                 ///< (particles)
    std::vector<std::uint32_t> joint;  ///< (particles) the smallest that it is sewn to, or itself
    std::size_t particles() const { return cloth.size(); }
};

/// Collects the faces of cloths and makes their surface.
class SurfaceBuilder {
public:
    /// A grid of nu × nv particles from `first` on, i along u; closed in u where `tube` says so. Cells are
    /// cut along alternating diagonals, so that no direction is preferred.
    void add_grid(std::uint32_t first, int nu, int nv, bool tube);
    /// A mesh of `count` particles from `first` on, whose faces of three or four corners are given by
    /// add_face().
    void add_mesh(std::uint32_t first, std::uint32_t count);
    void add_face(std::span<const std::uint32_t> corners);
    /// Two particles that a seam brings together: what ends at one and at the other has a corner in common.
    void sew(std::uint32_t p, std::uint32_t q);

    Surface build();

private:
    void begin_cloth(std::uint32_t first, std::uint32_t count);
    Surface out_;
    std::vector<std::array<std::uint32_t, 2>> seams_;
};

}  // namespace unravel::sim
