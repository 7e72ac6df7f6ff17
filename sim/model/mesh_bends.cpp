#include "sim/model/mesh_bends.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/model/mesh_fans.hpp"
#include "sim/model/mesh_springs.hpp"

namespace unravel::sim {

namespace {

using Cell = MeshCloth::Cell;
using Spoke = Fan::Spoke;
constexpr double pi = std::numbers::pi;
// Two spokes are one straight run where they miss a straight angle by no more than this.
constexpr double most_bend = 25.0 * pi / 180.0;

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
