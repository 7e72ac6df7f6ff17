#include "sim/linear/aggregates.hpp"

#include <algorithm>
#include <numeric>

namespace unravel::sim {

namespace {

constexpr std::uint32_t none = Aggregates::none;
// A level of no more nodes is the last.
constexpr std::size_t coarsest_aggregates = 32;
// So is one that has more than this share of the level above.
constexpr double least_shrinking = 0.8;
// Members beyond which an aggregate takes no stray in.
constexpr std::uint32_t most_members = 6;

// An undirected graph by rows.
struct Graph {
    struct Edge {
        std::uint32_t from, to;
        double weight;
    };
    std::vector<std::uint32_t> start;  // (nodes + 1)
    std::vector<Edge> edges;
    std::size_t nodes() const { return start.size() - 1; }
    std::span<const Edge> of(std::uint32_t node) const {
        return {edges.data() + start[node], edges.data() + start[node + 1]};
    }
};

// Edges of the same ends become one, of their summed weight.
Graph graph_of(std::size_t nodes, std::vector<Graph::Edge> edges) {
    std::stable_sort(edges.begin(), edges.end(), [](const Graph::Edge& a, const Graph::Edge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    Graph graph;
    graph.start.assign(nodes + 1, 0);
    for (const Graph::Edge& e : edges) {
        if (!graph.edges.empty() && graph.edges.back().from == e.from && graph.edges.back().to == e.to) {
            graph.edges.back().weight += e.weight;
        } else {
            graph.edges.push_back(e);
            ++graph.start[e.from + 1];
        }
    }
    for (std::size_t k = 0; k < nodes; ++k) graph.start[k + 1] += graph.start[k];
    return graph;
}

// Breadth first from `from`, appended to `order`; `seen` marks with `mark` what it reached.
void walk(const Graph& graph, std::uint32_t from, std::uint8_t mark, std::vector<std::uint8_t>& seen,
          std::vector<std::uint32_t>& order) {
    std::size_t next = order.size();
    order.push_back(from);
    seen[from] = mark;
    for (; next < order.size(); ++next) {
        for (const Graph::Edge& e : graph.of(order[next])) {
            if (seen[e.to] == mark) continue;
            seen[e.to] = mark;
            order.push_back(e.to);
        }
    }
}

std::vector<std::uint32_t> walking_order(const Graph& graph) {
    std::vector<std::uint32_t> order;
    std::vector<std::uint8_t> seen(graph.nodes(), 0);
    order.reserve(graph.nodes());
    for (std::uint32_t node = 0; node < graph.nodes(); ++node) {
        if (seen[node]) continue;
        // What is reached last lies at a far end: there the walk that counts begins.
        const std::size_t before = order.size();
        walk(graph, node, 1, seen, order);
        const std::uint32_t far = order.back();
        order.resize(before);
        walk(graph, far, 2, seen, order);
    }
    return order;
}

// Pairs of nodes, each with the unpaired neighbour that it is most strongly joined to.
std::vector<std::uint32_t> match(const Graph& graph, std::uint32_t& count) {
    std::vector<std::uint32_t> pair(graph.nodes(), none);
    count = 0;
    for (std::uint32_t node = 0; node < graph.nodes(); ++node) {
        if (pair[node] != none) continue;
        std::uint32_t best = none;
        double most = 0;
        for (const Graph::Edge& e : graph.of(node)) {
            // Weights that differ by rounding alone are the same.
            if (pair[e.to] != none || e.weight <= most * (1 + 1e-6)) continue;
            most = e.weight;
            best = e.to;
        }
        pair[node] = count;
        if (best != none) pair[best] = count;
        ++count;
    }
    return pair;
}

// The graph of groups of nodes; edges count how many of the nodes' edges they stand for, or sum their
// weights.
Graph grouped(const Graph& graph, const std::vector<std::uint32_t>& group, std::size_t groups, bool count) {
    std::vector<Graph::Edge> edges;
    edges.reserve(graph.edges.size());
    for (const Graph::Edge& e : graph.edges) {
        if (group[e.from] != group[e.to])
            edges.push_back({group[e.from], group[e.to], count ? 1.0 : e.weight});
    }
    return graph_of(groups, std::move(edges));
}

// Gives nodes that are alone to a neighbour's aggregate.
void take_strays_in(const Graph& graph, std::vector<std::uint32_t>& aggregate, std::size_t count) {
    std::vector<std::uint32_t> members(count, 0);
    for (const std::uint32_t a : aggregate) ++members[a];
    for (std::uint32_t node = 0; node < graph.nodes(); ++node) {
        if (members[aggregate[node]] != 1) continue;
        std::uint32_t best = none, most = 0;
        for (const Graph::Edge& e : graph.of(node)) {
            const std::uint32_t a = aggregate[e.to];
            if (members[a] < 2 || members[a] > most_members) continue;
            std::uint32_t joined = 0;
            for (const Graph::Edge& other : graph.of(node)) joined += aggregate[other.to] == a;
            if (joined <= most) continue;
            most = joined;
            best = a;
        }
        if (best == none) continue;
        members[aggregate[node]] = 0;
        aggregate[node] = best;
        ++members[best];
    }
}

// Numbers aggregates as their first members come; returns how many there are.
std::uint32_t number(std::vector<std::uint32_t>& aggregate) {
    std::vector<std::uint32_t> as(aggregate.size(), none);
    std::uint32_t count = 0;
    for (std::uint32_t& a : aggregate) {
        if (as[a] == none) as[a] = count++;
        a = as[a];
    }
    return count;
}

}  // namespace

Aggregates make_aggregates(std::size_t particles, const ExtensionSprings& springs,
                           std::span<const Aggregates::Join> joins) {
    std::vector<Graph::Edge> edges;
    edges.reserve(2 * (springs.size() + joins.size()));
    const auto add = [&](std::uint32_t i, std::uint32_t j, double stiffness) {
        if (i == j) return;
        edges.push_back({i, j, stiffness});
        edges.push_back({j, i, stiffness});
    };
    for (std::size_t s = 0; s < springs.size(); ++s) add(springs.i[s], springs.j[s], springs.stiffness[s]);
    for (const Aggregates::Join& join : joins) add(join.i, join.j, join.stiffness);

    Aggregates out;
    {
        const Graph as_numbered = graph_of(particles, edges);
        out.order = walking_order(as_numbered);
    }
    std::vector<std::uint32_t> place(particles);
    for (std::uint32_t k = 0; k < particles; ++k) place[out.order[k]] = k;
    for (Graph::Edge& e : edges) e = {place[e.from], place[e.to], e.weight};
    Graph level = graph_of(particles, std::move(edges));
    while (level.nodes() > coarsest_aggregates) {
        std::uint32_t pairs = 0, aggregates = 0;
        std::vector<std::uint32_t> parent = match(level, pairs);
        const std::vector<std::uint32_t> of_pair = match(grouped(level, parent, pairs, true), aggregates);
        for (std::uint32_t& p : parent) p = of_pair[p];
        take_strays_in(level, parent, aggregates);
        aggregates = number(parent);
        if (aggregates > least_shrinking * static_cast<double>(level.nodes())) break;
        level = grouped(level, parent, aggregates, false);
        out.parent.push_back(std::move(parent));
    }
    return out;
}

}  // namespace unravel::sim
