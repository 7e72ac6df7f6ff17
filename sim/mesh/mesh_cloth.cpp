#include "sim/mesh/mesh_cloth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace unravel::sim {

namespace {

// Two triangles are one cell where its angles differ from a right angle by no more than this.
constexpr double most_skew = 25.0 * std::numbers::pi / 180.0;

struct Side {
    std::uint32_t low, high, face, corner;  // the edge from corner to corner + 1
};

std::vector<Side> sides_of(const std::vector<PolygonMesh::Face>& faces) {
    std::vector<Side> out;
    out.reserve(4 * faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        for (std::uint32_t k = 0; k < faces[f].corners; ++k) {
            const std::uint32_t a = faces[f].vertex[k], b = faces[f].vertex[(k + 1) % faces[f].corners];
            out.push_back({std::min(a, b), std::max(a, b), f, k});
        }
    }
    std::sort(out.begin(), out.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return out;
}

double angle_at(const Vec3& x, const Vec3& from, const Vec3& to) {
    const Vec3 a = from - x, b = to - x;
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// A quad of two triangles that share the edge from corner k of f to the next.
struct Pair {
    double skew;  // largest difference of an angle from a right one
    std::uint32_t f, k, g, l;
};

Pair pair_of(const std::vector<Vec3>& x, const std::vector<PolygonMesh::Face>& faces, const Side& one,
             const Side& other) {
    Pair pair{0, one.face, one.corner, other.face, other.corner};
    const auto angle = [&](std::uint32_t face, std::uint32_t corner) {
        const auto& v = faces[face].vertex;
        return angle_at(x[v[corner % 3]], x[v[(corner + 1) % 3]], x[v[(corner + 2) % 3]]);
    };
    // Corner k of f and corner l + 1 of g are the same vertex, and so are k + 1 and l.
    const std::array<double, 4> angles{angle(pair.f, pair.k) + angle(pair.g, pair.l + 1),
                                       angle(pair.f, pair.k + 1) + angle(pair.g, pair.l),
                                       angle(pair.f, pair.k + 2), angle(pair.g, pair.l + 2)};
    for (const double a : angles) pair.skew = std::max(pair.skew, std::abs(a - 0.5 * std::numbers::pi));
    return pair;
}

// Triangles two by two, the most rectangular pairs first.
std::vector<Pair> pair_triangles(const std::vector<Vec3>& x, const std::vector<PolygonMesh::Face>& faces) {
    std::vector<Pair> candidates, taken;
    const std::vector<Side> sides = sides_of(faces);
    for (std::size_t s = 1; s < sides.size(); ++s) {
        const Side &a = sides[s - 1], &b = sides[s];
        if (a.low != b.low || a.high != b.high) continue;
        if (faces[a.face].corners != 3 || faces[b.face].corners != 3) continue;
        const Pair pair = pair_of(x, faces, a, b);
        if (pair.skew <= most_skew) candidates.push_back(pair);
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Pair& a, const Pair& b) { return a.skew < b.skew; });
    std::vector<char> used(faces.size(), 0);
    for (const Pair& pair : candidates) {
        if (used[pair.f] || used[pair.g]) continue;
        used[pair.f] = used[pair.g] = 1;
        taken.push_back(pair);
    }
    std::sort(taken.begin(), taken.end(), [](const Pair& a, const Pair& b) { return a.f < b.f; });
    return taken;
}

void make_cells(MeshCloth& mesh) {
    const std::vector<Pair> pairs = pair_triangles(mesh.rest, mesh.faces);
    std::vector<char> paired(mesh.faces.size(), 0);
    auto next = pairs.begin();
    for (const Pair& pair : pairs) paired[pair.f] = paired[pair.g] = 1;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const PolygonMesh::Face& face = mesh.faces[f];
        if (!paired[f]) {
            mesh.cells.push_back({face.corners, face.vertex, face.uv});
        } else if (next != pairs.end() && next->f == f) {
            const PolygonMesh::Face& other = mesh.faces[next->g];
            const std::uint32_t k = next->k, l = next->l;
            MeshCloth::Cell cell;
            cell.corners = 4;
            cell.vertex = {face.vertex[k], other.vertex[(l + 2) % 3], face.vertex[(k + 1) % 3],
                           face.vertex[(k + 2) % 3]};
            cell.uv = {face.uv[k], other.uv[(l + 2) % 3], face.uv[(k + 1) % 3], face.uv[(k + 2) % 3]};
            mesh.cells.push_back(cell);
            ++next;
        }
    }
}

void make_edges(MeshCloth& mesh) {
    for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
        const MeshCloth::Cell& cell = mesh.cells[c];
        for (std::size_t k = 0; k < cell.corners; ++k) {
            const std::uint32_t a = cell.vertex[k], b = cell.vertex[(k + 1) % cell.corners];
            mesh.edges.push_back({std::min(a, b), std::max(a, b), {c, no_index}});
        }
    }
    std::sort(mesh.edges.begin(), mesh.edges.end(), [](const auto& p, const auto& q) {
        return std::tie(p.a, p.b, p.cell) < std::tie(q.a, q.b, q.cell);
    });
    std::size_t last = 0;
    for (std::size_t e = 1; e < mesh.edges.size(); ++e) {
        MeshCloth::Edge& kept = mesh.edges[last];
        const MeshCloth::Edge& edge = mesh.edges[e];
        if (kept.a == edge.a && kept.b == edge.b)
            kept.cell[1] = edge.cell[0];
        else
            mesh.edges[++last] = edge;
    }
    mesh.edges.resize(mesh.edges.empty() ? 0 : last + 1);
}

// Segments that run along a face are drawn lines, the others are seams.
void make_seams(const PolygonMesh& from, MeshCloth& mesh) {
    std::vector<std::array<std::uint32_t, 2>> sides;
    for (const Side& side : sides_of(mesh.faces)) sides.push_back({side.low, side.high});
    for (const auto& [a, b] : from.lines) {
        const std::array<std::uint32_t, 2> seam{std::min(a, b), std::max(a, b)};
        if (a != b && !std::binary_search(sides.begin(), sides.end(), seam)) mesh.seams.push_back(seam);
    }
    std::sort(mesh.seams.begin(), mesh.seams.end());
    mesh.seams.erase(std::unique(mesh.seams.begin(), mesh.seams.end()), mesh.seams.end());
}

}  // namespace

double MeshCloth::area(const Cell& cell) const {
    const Vec3 &a = rest[cell.vertex[0]], &b = rest[cell.vertex[1]], &c = rest[cell.vertex[2]];
    if (cell.corners == 3) return 0.5 * (b - a).cross(c - a).norm();
    return 0.5 * (c - a).cross(rest[cell.vertex[3]] - b).norm();
}

Vec3 MeshCloth::extent() const {
    Vec3 low = rest.front(), high = low;
    for (const Vec3& x : rest) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    return high - low;
}

Vec3 from_file(const Vec3& x, double scale, UpAxis up) {
    return up == UpAxis::y ? Vec3(scale * x) : Vec3(scale * x.x(), scale * x.z(), -scale * x.y());
}

MeshCloth make_mesh_cloth(PolygonMesh from, double scale, UpAxis up) {
    MeshCloth mesh;
    mesh.rest = std::move(from.positions);
    for (Vec3& x : mesh.rest) x = from_file(x, scale, up);
    mesh.uvs = std::move(from.uvs);
    mesh.faces = std::move(from.faces);
    mesh.groups = std::move(from.groups);
    make_cells(mesh);
    make_edges(mesh);
    make_seams(from, mesh);
    return mesh;
}

std::vector<double> vertex_areas(const MeshCloth& mesh) {
    std::vector<double> areas(mesh.rest.size(), 0.0);
    for (const MeshCloth::Cell& cell : mesh.cells) {
        const double share = mesh.area(cell) / cell.corners;
        for (std::size_t k = 0; k < cell.corners; ++k) areas[cell.vertex[k]] += share;
    }
    return areas;
}

}  // namespace unravel::sim
