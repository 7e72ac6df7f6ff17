#include "sim/mesh/mesh_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace unravel::sim {

namespace {

constexpr std::uint32_t leaf_size = 4;

double box_square(const Vec3& low, const Vec3& high, const Vec3& x) {
    return (low - x).cwiseMax(x - high).cwiseMax(0.0).squaredNorm();
}

enum class Feature : std::uint8_t { face, edge0, edge1, edge2, vertex0, vertex1, vertex2 };

// The point of triangle abc nearest to p, by the Voronoi region that p lies in (Ericson, "Real-Time Collision
// Detection", 2005, Sec. 5.1.5). Edge k runs from corner k to the next.
Feature nearest_feature(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, Vec3& weights) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return weights = {1, 0, 0}, Feature::vertex0;
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return weights = {0, 1, 0}, Feature::vertex1;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double v = d1 / (d1 - d3);
        return weights = {1 - v, v, 0}, Feature::edge0;
    }
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return weights = {0, 0, 1}, Feature::vertex2;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double w = d2 / (d2 - d6);
        return weights = {1 - w, 0, w}, Feature::edge2;
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return weights = {0, 1 - w, w}, Feature::edge1;
    }
    const double whole = va + vb + vc;
    return weights = {va / whole, vb / whole, vc / whole}, Feature::face;
}

}  // namespace

MeshTree::MeshTree(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles)
    : triangles_(triangles.begin(), triangles.end()) {
    std::vector<Vec3> centres;
    centres.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles)
        centres.push_back((positions[a] + positions[b] + positions[c]) / 3);
    nodes_.reserve(2 * triangles.size());
    nodes_.emplace_back();
    // Triangles are put into the tree's order through their numbers, so that centres can stay where they are.
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    struct Task {
        std::uint32_t node, first, count;
    };
    std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(triangles.size())}};
    while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        nodes_[task.node] = {Vec3::Zero(), Vec3::Zero(), task.first, task.count};
        if (task.count <= leaf_size) continue;
        Vec3 low = centres[order[task.first]], high = low;
        for (std::uint32_t k = task.first; k < task.first + task.count; ++k) {
            low = low.cwiseMin(centres[order[k]]);
            high = high.cwiseMax(centres[order[k]]);
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        const std::uint32_t half = task.count / 2;
        std::nth_element(order.begin() + task.first, order.begin() + task.first + half,
                         order.begin() + task.first + task.count, [&](std::uint32_t p, std::uint32_t q) {
                             const double x = centres[p][axis], y = centres[q][axis];
                             return x != y ? x < y : p < q;
                         });
        const auto children = static_cast<std::uint32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        nodes_[task.node].first = children;
        nodes_[task.node].count = 0;
        tasks.push_back({children, task.first, half});
        tasks.push_back({children + 1, task.first + half, task.count - half});
    }
    for (std::size_t t = 0; t < order.size(); ++t) triangles_[t] = triangles[order[t]];
    make_features();
    refit(positions);
}

void MeshTree::make_features() {
    struct Side {
        std::uint32_t low, high, triangle, corner;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t, k});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    edge_of_.resize(triangles_.size());
    std::uint32_t edges = 0;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        if (s == 0 || sides[s].low != sides[s - 1].low || sides[s].high != sides[s - 1].high) ++edges;
        edge_of_[sides[s].triangle][sides[s].corner] = edges - 1;
    }
    edge_normals_.resize(edges);
}

void MeshTree::refit(std::span<const Vec3> positions) {
    positions_.assign(positions.begin(), positions.end());
    face_normals_.resize(triangles_.size());
    vertex_normals_.assign(positions.size(), Vec3::Zero());
    std::fill(edge_normals_.begin(), edge_normals_.end(), Vec3::Zero());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const std::array<std::uint32_t, 3>& v = triangles_[t];
        const Vec3 area = (positions_[v[1]] - positions_[v[0]]).cross(positions_[v[2]] - positions_[v[0]]);
        const double size = area.norm();
        const Vec3 n = size > 0 ? Vec3(area / size) : Vec3::Zero();
        face_normals_[t] = n;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = positions_[v[(k + 1) % 3]] - positions_[v[k]],
                       b = positions_[v[(k + 2) % 3]] - positions_[v[k]];
            vertex_normals_[v[k]] += std::atan2(a.cross(b).norm(), a.dot(b)) * n;
            edge_normals_[edge_of_[t][k]] += n;
        }
    }
    for (std::vector<Vec3>* normals : {&edge_normals_, &vertex_normals_}) {
        for (Vec3& n : *normals) {
            if (const double size = n.norm(); size > 0) n /= size;
        }
    }
    for (std::size_t k = nodes_.size(); k-- > 0;) {
        Node& node = nodes_[k];
        node.low.setConstant(std::numeric_limits<double>::infinity());
        node.high = -node.low;
        const auto include = [&](const Vec3& low, const Vec3& high) {
            node.low = node.low.cwiseMin(low);
            node.high = node.high.cwiseMax(high);
        };
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
            for (const std::uint32_t v : triangles_[t]) include(positions_[v], positions_[v]);
        }
        if (node.count == 0) {
            for (const std::uint32_t child : {node.first, node.first + 1})
                include(nodes_[child].low, nodes_[child].high);
        }
    }
}

MeshTree::Nearest MeshTree::nearest(const Vec3& x, double cutoff) const {
    Nearest found;
    const double outside = box_square(nodes_.front().low, nodes_.front().high, x);
    if (outside > cutoff * cutoff) {
        found.distance = std::sqrt(outside);
        return found;
    }
    double least = std::numeric_limits<double>::infinity();
    Feature feature = Feature::face;
    Vec3 foot = x;
    struct Visit {
        std::uint32_t node;
        double square;
    };
    std::array<Visit, 64> stack;  // twice the depth of a tree of 2³² leaves is not reached: halves are even
    std::size_t size = 0;
    stack[size++] = {0, outside};
    while (size > 0) {
        const Visit visit = stack[--size];
        if (visit.square >= least) continue;
        const Node& node = nodes_[visit.node];
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
            const auto& [a, b, c] = triangles_[t];
            Vec3 weights;
            const Feature here = nearest_feature(positions_[a], positions_[b], positions_[c], x, weights);
            const Vec3 point =
                weights.x() * positions_[a] + weights.y() * positions_[b] + weights.z() * positions_[c];
            const double square = (x - point).squaredNorm();
            if (square >= least) continue;
            least = square;
            feature = here;
            foot = point;
            found.triangle = t;
            found.weights = weights;
        }
        if (node.count > 0) continue;
        Visit near{node.first, box_square(nodes_[node.first].low, nodes_[node.first].high, x)};
        Visit far{node.first + 1, box_square(nodes_[node.first + 1].low, nodes_[node.first + 1].high, x)};
        if (far.square < near.square) std::swap(near, far);
        if (far.square < least) stack[size++] = far;
        if (near.square < least) stack[size++] = near;
    }
    const auto k = static_cast<std::size_t>(feature);
    const Vec3 pseudonormal = feature == Feature::face ? face_normals_[found.triangle]
                              : k < 4                  ? edge_normals_[edge_of_[found.triangle][k - 1]]
                                                       : vertex_normals_[triangles_[found.triangle][k - 4]];
    const Vec3 away = x - foot;
    const double distance = std::sqrt(least);
    const double sign = away.dot(pseudonormal) < 0 ? -1.0 : 1.0;
    found.distance = sign * distance;
    // On the surface itself the direction from the foot is rounding only.
    const bool on = distance <= 1e-9 * (nodes_.front().high - nodes_.front().low).maxCoeff();
    found.normal = on ? pseudonormal : Vec3(sign / distance * away);
    return found;
}

}  // namespace unravel::sim
