#pragma once

#include <span>

#include "sim/surface/surface.hpp"

namespace unravel::sim {

/// Box along the axes. [m]
struct Box {
    Vec3 low{0, 0, 0}, high{0, 0, 0};
    bool overlaps(const Box& other) const {
        return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
    }
    void include(const Box& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
};

/// Tree of boxes over a surface: its shape follows from where the cloth is at the start, cloth by cloth; its
/// boxes are made anew for every search. A leaf is a patch of a few neighbouring triangles with the edges and
/// vertices that belong to them.
class SurfaceTree {
public:
    SurfaceTree() = default;
    /// x   (particles) at the start [m]
    SurfaceTree(const Surface& surface, std::span<const Vec3> x);

    /// The boxes of everything, from those of the particles.
    void refit(const Surface& surface, std::span<const Box> particles);

    std::size_t leaves() const { return triangles.start.empty() ? 0 : triangles.start.size() - 1; }
    /// What belongs to each leaf, each feature to one: those of leaf k in list[start[k] … start[k + 1]).
    Lists triangles, edges, vertices;
    Lists corners;                                        ///< of each leaf: all corners of those, each once
    std::vector<Box> vertex_box, edge_box, triangle_box;  ///< (particles), (edges), (triangles)

    const Box& box_of(std::uint32_t leaf) const { return nodes_[node_of_[leaf]].box; }

    /// Calls f(other) for each leaf whose box overlaps that of `leaf` and whose number is not smaller.
    template <typename F>
    void each_partner(std::uint32_t leaf, const F& f) const {
        each_leaf(nodes_[node_of_[leaf]].box, leaf, f);
    }
    /// Calls f(leaf) for each leaf from `first` on whose box overlaps `box`.
    template <typename F>
    void each_leaf(const Box& box, std::uint32_t first, const F& f) const {
        std::array<std::uint32_t, 64> waiting;
        std::size_t count = 0;
        if (!nodes_.empty()) waiting[count++] = 0;
        while (count > 0) {
            const Node& node = nodes_[waiting[--count]];
            if (node.last <= first || !box.overlaps(node.box)) continue;
            if (node.child == 0) {
                f(node.first);
                continue;
            }
            waiting[count++] = node.child + 1;
            waiting[count++] = node.child;
        }
    }

private:
    struct Node {
        Box box;
        std::uint32_t first = 0, last = 0;  ///< leaves [first, last)
        std::uint32_t child = 0;            ///< and the next: children, behind their parent; 0: a leaf
    };
    struct Builder;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> node_of_;  ///< (leaves)
};

}  // namespace unravel::sim
