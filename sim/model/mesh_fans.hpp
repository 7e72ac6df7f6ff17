#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/mesh/mesh_cloth.hpp"

namespace unravel::sim {

/// The cells round a vertex of a mesh, laid flat, as far as they hang together by edges.
struct Fan {
    /// What leaves the vertex: edges, and the diagonals of quads.
    struct Spoke {
        std::uint32_t end;
        double angle;  ///< around the vertex, laid flat
        double length;
        bool diagonal;
    };
    std::vector<Spoke> spokes;  ///< in order round the vertex
    double whole = 0;           ///< sum of the cells' angles
    bool closed = false;        ///< no border passes through the vertex
    bool quads = false;
    std::vector<std::uint32_t> cells;
};

class FanWalk {
public:
    explicit FanWalk(const MeshCloth& mesh);

    /// Calls f(vertex, fan) for every fan of every vertex; where cloths only touch at a point it has several.
    template <typename F>
    void each(const F& f) const {
        for (std::uint32_t v = 0; v < mesh_.rest.size(); ++v) {
            std::vector<Wedge> left(wedges_.begin() + start_[v], wedges_.begin() + start_[v + 1]);
            while (!left.empty()) f(v, take_fan(v, left));
        }
    }

private:
    // A cell at a vertex, by the vertices that come after and before it in the cell.
    struct Wedge {
        std::uint32_t next, previous, cell;
    };
    Fan take_fan(std::uint32_t v, std::vector<Wedge>& left) const;
    void add(std::uint32_t v, const Wedge& wedge, Fan& fan) const;

    const MeshCloth& mesh_;
    std::vector<std::uint32_t> start_;
    std::vector<Wedge> wedges_;
};

}  // namespace unravel::sim
