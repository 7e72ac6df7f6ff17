#include "sim/model/mesh_bends.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/model/mesh_springs.hpp"

namespace unravel::sim {

namespace {

using Cell = MeshCloth::Cell;
constexpr double pi = std::numbers::pi;
// Two spokes are one straight run where they miss a straight angle by no more than this.
constexpr double most_bend = 25.0 * pi / 180.0;

// What leaves a vertex, in the order of its fan: edges, and the diagonals of quads.
struct Spoke {
    std::uint32_t end;
    double angle;  // around the vertex, laid flat
    double length;
};

struct Fan {
    std::vector<Spoke> spokes;
    double whole = 0;     // sum of the cells' angles
    bool closed = false;  // no border passes through the vertex
    bool quads = false;
};

// A cell at a vertex, by the vertices that come after and before it in the cell.
struct Wedge {
    std::uint32_t next, previous, cell;
};

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

class FanWalk {
public:
    FanWalk(const MeshCloth& mesh) : mesh_(mesh), start_(mesh.rest.size() + 1, 0) {
        for (const Cell& cell : mesh.cells) {
            for (std::size_t k = 0; k < cell.corners; ++k) ++start_[cell.vertex[k] + 1];
        }
        for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
        wedges_.resize(start_.back());
        std::vector<std::uint32_t> place(start_.begin(), start_.end() - 1);
        for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
            const Cell& cell = mesh.cells[c];
            for (std::size_t k = 0; k < cell.corners; ++k) {
                wedges_[place[cell.vertex[k]]++] = {cell.vertex[(k + 1) % cell.corners],
                                                    cell.vertex[(k + cell.corners - 1u) % cell.corners], c};
            }
        }
    }

    // Calls f(vertex, fan) for every fan of every vertex; where cloths only touch at a point it has several.
    template <typename F>
    void each(const F& f) const {
        for (std::uint32_t v = 0; v < mesh_.rest.size(); ++v) {
            std::vector<Wedge> left(wedges_.begin() + start_[v], wedges_.begin() + start_[v + 1]);
            while (!left.empty()) f(v, take_fan(v, left));
        }
    }

private:
    Fan take_fan(std::uint32_t v, std::vector<Wedge>& left) const {
        // A border's fan begins with the wedge that no other leads to.
        auto first = std::find_if(left.begin(), left.end(), [&](const Wedge& w) {
            return std::none_of(left.begin(), left.end(),
                                [&](const Wedge& other) { return other.previous == w.next; });
        });
        Fan fan;
        fan.closed = first == left.end();
        if (fan.closed) first = left.begin();
        const std::uint32_t origin = first->next;
        for (auto wedge = first; wedge != left.end();) {
            add(v, *wedge, fan);
            const std::uint32_t onward = wedge->previous;
            left.erase(wedge);
            wedge = std::find_if(left.begin(), left.end(), [&](const Wedge& w) { return w.next == onward; });
            if (wedge == left.end() && onward != origin)
                fan.spokes.push_back({onward, fan.whole, (mesh_.rest[onward] - mesh_.rest[v]).norm()});
        }
        return fan;
    }

    void add(std::uint32_t v, const Wedge& wedge, Fan& fan) const {
        const Vec3 &x = mesh_.rest[v], from = mesh_.rest[wedge.next] - x, to = mesh_.rest[wedge.previous] - x;
        fan.spokes.push_back({wedge.next, fan.whole, from.norm()});
        const Cell& cell = mesh_.cells[wedge.cell];
        if (cell.corners == 3) {
            fan.whole += angle_between(from, to);
            return;
        }
        fan.quads = true;
        std::uint32_t far = no_index;
        for (const std::uint32_t corner : cell.vertex) {
            if (corner != v && corner != wedge.next && corner != wedge.previous) far = corner;
        }
        const Vec3 across = mesh_.rest[far] - x;
        fan.whole += angle_between(from, across);
        fan.spokes.push_back({far, fan.whole, across.norm()});
        fan.whole += angle_between(across, to);
    }

    const MeshCloth& mesh_;
    std::vector<std::uint32_t> start_;
    std::vector<Wedge> wedges_;
};

// The spoke that runs on from spoke k, or the number of spokes.
std::size_t onward(const Fan& fan, double scale, std::size_t k) {
    std::size_t found = fan.spokes.size();
    double least = most_bend;
    for (std::size_t j = 0; j < fan.spokes.size(); ++j) {
        if (j == k) continue;
        double turn = scale * std::abs(fan.spokes[j].angle - fan.spokes[k].angle);
        if (fan.closed) turn = std::min(turn, 2 * pi - turn);
        const double off = std::abs(turn - pi);
        if (off < least) {
            least = off;
            found = j;
        }
    }
    return found;
}

void add_runs(std::uint32_t v, double area, const Fan& fan, std::vector<BendStrip>& strips) {
    const std::size_t n = fan.spokes.size();
    if (!fan.quads || n < 3) return;
    // Cloth that is no plane around the vertex is spread over the whole turn.
    const double scale = fan.closed ? 2 * pi / fan.whole : 1.0;
    const double directions =
        fan.closed ? 0.5 * static_cast<double>(n) : static_cast<double>(n - 1) * pi / fan.whole;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t j = onward(fan, scale, k);
        if (j == n || j < k || onward(fan, scale, j) != k) continue;
        const Spoke &a = fan.spokes[k], &b = fan.spokes[j];
        const double turn = scale * (b.angle - a.angle);
        const double square =
            a.length * a.length + b.length * b.length - 2 * a.length * b.length * std::cos(turn);
        strips.push_back({a.end, v, b.end, std::sqrt(square),
                          4.0 / (3.0 * directions) * area / (0.5 * (a.length + b.length))});
    }
}

void add_wing(const MeshCloth& mesh, const MeshCloth::Edge& edge, std::vector<BendStrip>& strips) {
    if (edge.cell[1] == no_index) return;
    const Cell &one = mesh.cells[edge.cell[0]], &other = mesh.cells[edge.cell[1]];
    if (one.corners != 3 || other.corners != 3) return;
    const auto opposite = [&](const Cell& cell) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (cell.vertex[k] != edge.a && cell.vertex[k] != edge.b) return cell.vertex[k];
        }
        return no_index;
    };
    const std::uint32_t p = opposite(one), q = opposite(other);
    const Vec3 along = (mesh.rest[edge.b] - mesh.rest[edge.a]).normalized();
    // Place of a wing's tip along the edge and its distance from it.
    const auto laid = [&](std::uint32_t v) {
        const Vec3 d = mesh.rest[v] - mesh.rest[edge.a];
        return Vec2(along.dot(d), along.cross(d).norm());
    };
    const Vec2 tip = laid(p), tail = laid(q);
    const double rest = std::hypot(tip.x() - tail.x(), tip.y() + tail.y());
    strips.push_back({p, no_index, q, rest, 8.0 / 9.0 * (mesh.area(one) + mesh.area(other)) / rest});
}

}  // namespace

std::vector<BendStrip> bend_strips(const MeshCloth& mesh) {
    std::vector<BendStrip> strips;
    const std::vector<double> areas = vertex_areas(mesh);
    FanWalk(mesh).each([&](std::uint32_t v, const Fan& fan) { add_runs(v, areas[v], fan, strips); });
    for (const MeshCloth::Edge& edge : mesh.edges) add_wing(mesh, edge, strips);
    return strips;
}

void add_mesh_bends(const Cloth& cloth, std::uint32_t first, BendSprings& bends) {
    const MeshMaterials materials(cloth);
    for (const BendStrip& strip : bend_strips(*cloth.geometry)) {
        const std::array held{strip.a, strip.b, strip.middle == no_index ? strip.a : strip.middle};
        const Material& m = materials.at(held);
        const double stiffness = m.bend * strip.width;
        if (stiffness <= 0 || strip.a == strip.b) continue;
        bends.add(first + strip.a, first + strip.b, strip.rest, stiffness, m.buckling_strain);
    }
}

}  // namespace unravel::sim
