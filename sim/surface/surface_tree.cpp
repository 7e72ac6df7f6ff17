#include "sim/surface/surface_tree.hpp"

#include <algorithm>
#include <numeric>

namespace unravel::sim {

namespace {

// Triangles or loose edges of a leaf, at most: few enough that trying all against all costs about as much as
// finding the leaf.
constexpr std::size_t patch_size = 8;

}  // namespace

// Triangles and loose edges are sorted into leaves by their middles.
struct SurfaceTree::Builder {
    const Surface& surface;
    SurfaceTree& tree;
    struct Item {
        std::uint32_t cloth;
        bool loose;
        std::uint32_t number;
        Vec3 middle;
    };
    std::vector<Item> items;

    void add_items(std::span<const Vec3> x) {
        for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
            const auto& [a, b, c] = surface.triangles[t];
            items.push_back({surface.cloth[a], false, t, (x[a] + x[b] + x[c]) / 3});
        }
        for (std::uint32_t e = 0; e < surface.edges.size(); ++e) {
            const auto& [a, b] = surface.edges[e];
            if (surface.sides[e][0] == Surface::none)
                items.push_back({surface.cloth[a], true, e, 0.5 * (x[a] + x[b])});
        }
        std::stable_sort(items.begin(), items.end(),
                         [](const Item& one, const Item& other) { return one.cloth < other.cloth; });
    }

    // Where to cut [begin, end): between cloths where there are several, else in the middle of the longest
    // axis.
    std::size_t cut(std::size_t begin, std::size_t end) {
        const std::size_t middle = begin + (end - begin) / 2;
        if (items[begin].cloth != items[end - 1].cloth) {
            const auto same = [&](const Item& one, const Item& other) { return one.cloth < other.cloth; };
            const auto first = items.begin() + static_cast<std::ptrdiff_t>(begin),
                       last = items.begin() + static_cast<std::ptrdiff_t>(end);
            auto at = std::lower_bound(first, last, items[middle], same);
            if (at == first) at = std::upper_bound(first, last, items[middle], same);
            return static_cast<std::size_t>(at - items.begin());
        }
        Vec3 low = items[begin].middle, high = low;
        for (std::size_t k = begin; k < end; ++k) {
            low = low.cwiseMin(items[k].middle);
            high = high.cwiseMax(items[k].middle);
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const auto at = [&](std::size_t k) { return items.begin() + static_cast<std::ptrdiff_t>(k); };
        std::nth_element(at(begin), at(middle), at(end), [&](const Item& one, const Item& other) {
            const double a = one.middle[axis], b = other.middle[axis];
            return a != b ? a < b : one.number < other.number;
        });
        return middle;
    }

    void make_leaf(std::size_t begin, std::size_t end) {
        std::sort(items.begin() + static_cast<std::ptrdiff_t>(begin),
                  items.begin() + static_cast<std::ptrdiff_t>(end), [](const Item& one, const Item& other) {
                      return std::pair(one.loose, one.number) < std::pair(other.loose, other.number);
                  });
        for (std::size_t k = begin; k < end; ++k)
            (items[k].loose ? tree.edges : tree.triangles).list.push_back(items[k].number);
        tree.triangles.start.push_back(static_cast<std::uint32_t>(tree.triangles.list.size()));
        tree.edges.start.push_back(static_cast<std::uint32_t>(tree.edges.list.size()));
    }

    void split(std::uint32_t node, std::size_t begin, std::size_t end) {
        std::vector<Node>& nodes = tree.nodes_;
        nodes[node].first = static_cast<std::uint32_t>(tree.triangles.start.size() - 1);
        if (end - begin <= patch_size && items[begin].cloth == items[end - 1].cloth) {
            tree.node_of_.push_back(node);
            make_leaf(begin, end);
        } else {
            const std::size_t middle = cut(begin, end);
            const auto child = static_cast<std::uint32_t>(nodes.size());
            nodes[node].child = child;
            nodes.resize(nodes.size() + 2);
            split(child, begin, middle);
            split(child + 1, middle, end);
        }
        nodes[node].last = static_cast<std::uint32_t>(tree.triangles.start.size() - 1);
    }

    // Edges and vertices go to the first leaf that has a triangle at them; loose edges have theirs already.
    void deal_edges_and_vertices() {
        std::vector<std::vector<std::uint32_t>> edges_of(tree.leaves()), vertices_of(tree.leaves());
        std::vector<std::uint8_t> dealt(surface.edges.size(), 0), met(surface.particles(), 0);
        for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
            const auto take_edge = [&](std::uint32_t e) {
                if (dealt[e]) return;
                dealt[e] = 1;
                edges_of[leaf].push_back(e);
                for (const std::uint32_t p : surface.edges[e]) {
                    if (met[p]) continue;
                    met[p] = 1;
                    vertices_of[leaf].push_back(p);
                }
            };
            for (const std::uint32_t e : tree.edges.of(leaf)) take_edge(e);
            for (const std::uint32_t t : tree.triangles.of(leaf)) {
                for (const std::uint32_t p : surface.triangles[t]) {
                    for (const std::uint32_t e : surface.edges_at.of(p)) {
                        if (surface.sides[e][0] == t || surface.sides[e][1] == t) take_edge(e);
                    }
                }
            }
        }
        const auto pack = [&](const std::vector<std::vector<std::uint32_t>>& of, Lists& out) {
            out = {};
            out.start.push_back(0);
            for (const std::vector<std::uint32_t>& part : of) {
                out.list.insert(out.list.end(), part.begin(), part.end());
                out.start.push_back(static_cast<std::uint32_t>(out.list.size()));
            }
        };
        pack(edges_of, tree.edges);
        pack(vertices_of, tree.vertices);
        std::vector<std::vector<std::uint32_t>> corners_of(tree.leaves());
        for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
            std::vector<std::uint32_t>& corners = corners_of[leaf];
            for (const std::uint32_t t : tree.triangles.of(leaf))
                corners.insert(corners.end(), surface.triangles[t].begin(), surface.triangles[t].end());
            for (const std::uint32_t e : tree.edges.of(leaf))
                corners.insert(corners.end(), surface.edges[e].begin(), surface.edges[e].end());
            std::sort(corners.begin(), corners.end());
            corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        }
        pack(corners_of, tree.corners);
    }
};

SurfaceTree::SurfaceTree(const Surface& surface, std::span<const Vec3> x) {
    Builder builder{surface, *this, {}};
    triangles.start = edges.start = vertices.start = corners.start = {0};
    builder.add_items(x);
    if (builder.items.empty()) return;
    nodes_.resize(1);
    builder.split(0, 0, builder.items.size());
    builder.deal_edges_and_vertices();
}

void SurfaceTree::refit(const Surface& surface, std::span<const Box> particles) {
    vertex_box.assign(particles.begin(), particles.end());
    edge_box.resize(surface.edges.size());
    triangle_box.resize(surface.triangles.size());
    const auto around = [&](const auto& ends) {
        Box box = particles[ends[0]];
        for (std::size_t k = 1; k < ends.size(); ++k) box.include(particles[ends[k]]);
        return box;
    };
    parallel_each(edge_box.size(), [&](std::size_t e) { edge_box[e] = around(surface.edges[e]); });
    parallel_each(triangle_box.size(),
                  [&](std::size_t t) { triangle_box[t] = around(surface.triangles[t]); });
    parallel_each(leaves(), [&](std::size_t k) {
        const auto leaf = static_cast<std::uint32_t>(k);
        Box& box = nodes_[node_of_[leaf]].box;
        bool first = true;
        const auto add = [&](const Box& part) {
            if (first) box = part;
            first = false;
            box.include(part);
        };
        for (const std::uint32_t t : triangles.of(leaf)) add(triangle_box[t]);
        for (const std::uint32_t e : edges.of(leaf)) add(edge_box[e]);
        for (const std::uint32_t p : vertices.of(leaf)) add(vertex_box[p]);
    });
    for (std::size_t k = nodes_.size(); k-- > 0;) {
        Node& node = nodes_[k];
        if (node.child == 0) continue;
        node.box = nodes_[node.child].box;
        node.box.include(nodes_[node.child + 1].box);
    }
}

}  // namespace unravel::sim
