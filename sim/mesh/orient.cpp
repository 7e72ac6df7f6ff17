// Repairs of which way faces look, and of holes (repair.hpp).

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "sim/mesh/cut_polygon.hpp"
#include "sim/mesh/half_edges.hpp"
#include "sim/mesh/repair.hpp"

namespace unravel::sim {

namespace {

void turn_face(PolygonMesh::Face& face) {
    std::reverse(face.vertex.begin(), face.vertex.begin() + face.corners);
    std::reverse(face.uv.begin(), face.uv.begin() + face.corners);
}

// FaceNeighbours across edges of two faces, and whether the two face opposite ways.
struct FaceNeighbours {
    struct Side {
        std::uint32_t face;
        bool opposite;
    };
    std::vector<std::uint32_t> first;  // (faces + 1)
    std::vector<Side> side;

    FaceNeighbours(std::size_t faces, const std::vector<HalfEdge>& sides) : first(faces + 1, 0) {
        const auto each_pair = [&](const auto& visit) {
            for_each_edge(sides, [&](std::size_t a, std::size_t end) {
                if (end - a == 2) visit(sides[a], sides[a + 1]);
            });
        };
        each_pair([&](const HalfEdge& a, const HalfEdge& b) {
            ++first[a.face + 1];
            ++first[b.face + 1];
        });
        for (std::size_t f = 0; f < faces; ++f) first[f + 1] += first[f];
        side.resize(first.back());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        each_pair([&](const HalfEdge& a, const HalfEdge& b) {
            side[next[a.face]++] = {b.face, a.forward == b.forward};
            side[next[b.face]++] = {a.face, a.forward == b.forward};
        });
    }
};

// Of more pieces than this none is taken for another's hollow, which takes their number's square to tell.
constexpr std::size_t most_nested = 4096;

struct Enclosure {
    double volume = 0;  // six times it; positive: faces look outward
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    bool inside(const Enclosure& other) const {
        return (low.array() > other.low.array()).all() && (high.array() < other.high.array()).all();
    }
};

Vec3 vector_area(const PolygonMesh& mesh, const std::vector<std::uint32_t>& loop) {
    Vec3 area(0, 0, 0);
    const Vec3& origin = mesh.positions[loop[0]];
    for (std::size_t k = 2; k < loop.size(); ++k)
        area += 0.5 * (mesh.positions[loop[k - 1]] - origin).cross(mesh.positions[loop[k]] - origin);
    return area;
}

}  // namespace

void turn_alike(PolygonMesh& mesh, MeshMessages& said) {
    const FaceNeighbours neighbours(mesh.faces.size(), half_edges(mesh.faces));
    std::vector<signed char> turn(mesh.faces.size(), -1);
    std::vector<std::uint32_t> piece;
    std::size_t turned = 0;
    for (std::uint32_t start = 0; start < mesh.faces.size(); ++start) {
        if (turn[start] >= 0) continue;
        piece.assign(1, start);
        turn[start] = 0;
        bool possible = true;
        std::size_t others = 0;
        for (std::size_t k = 0; k < piece.size(); ++k) {
            const std::uint32_t f = piece[k];
            others += static_cast<std::size_t>(turn[f]);
            for (std::uint32_t s = neighbours.first[f]; s < neighbours.first[f + 1]; ++s) {
                const auto [g, opposite] = neighbours.side[s];
                const auto wanted = static_cast<signed char>(turn[f] ^ static_cast<int>(opposite));
                if (turn[g] < 0) {
                    turn[g] = wanted;
                    piece.push_back(g);
                }
                possible = possible && turn[g] == wanted;
            }
        }
        if (!possible || others == 0) continue;
        const int which = 2 * others <= piece.size() ? 1 : 0;
        for (const std::uint32_t f : piece) {
            if (turn[f] != which) continue;
            turn_face(mesh.faces[f]);
            ++turned;
        }
    }
    if (turned > 0)
        said.notes.push_back(fmt::format("{} the other way than the neighbours: turned",
                                         counted(turned, "face looks", "faces look")));
}

void turn_outward(PolygonMesh& mesh, MeshMessages& said) {
    const std::vector<std::uint32_t> piece = connected_pieces(mesh.faces.size(), half_edges(mesh.faces));
    std::vector<Enclosure> all(piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end()) + 1);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        Enclosure& one = all[piece[f]];
        const PolygonMesh::Face& face = mesh.faces[f];
        const auto x = [&](std::size_t k) {
            return Vec3(mesh.positions[face.vertex[k]] - mesh.positions.front());
        };
        for (std::size_t k = 2; k < face.corners; ++k) one.volume += x(0).dot(x(k - 1).cross(x(k)));
        for (std::size_t k = 0; k < face.corners; ++k) {
            one.low = one.low.cwiseMin(x(k));
            one.high = one.high.cwiseMax(x(k));
        }
    }
    std::vector<char> inward(all.size(), 0);
    std::size_t count = 0;
    for (std::size_t p = 0; p < all.size(); ++p) {
        inward[p] = all[p].volume < 0 && (all.size() > most_nested ||
                                          std::none_of(all.begin(), all.end(), [&](const Enclosure& other) {
                                              return all[p].inside(other);
                                          }));
        count += static_cast<std::size_t>(inward[p]);
    }
    if (count == 0) return;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (inward[piece[f]]) turn_face(mesh.faces[f]);
    }
    said.notes.push_back(all.size() == 1 ? "the faces look inward: all turned"
                                         : fmt::format("the faces of {} inward: turned",
                                                       counted(count, "piece look", "pieces look")));
}

void cap_holes(PolygonMesh& mesh, double largest, MeshMessages& said) {
    const std::vector<std::vector<std::uint32_t>> loops = border_loops(mesh.faces);
    double surface = 0;
    for (const PolygonMesh::Face& face : mesh.faces) surface += face_area(mesh.positions, face);
    std::vector<std::vector<std::uint32_t>> closed;
    for (const std::vector<std::uint32_t>& loop : loops) {
        if (loop.size() < 3 || loop.size() > most_corners) continue;
        if (vector_area(mesh, loop).norm() > largest * surface) continue;
        // The faces that close it run round it the other way.
        std::vector<std::uint32_t> vertex(loop.rbegin(), loop.rend()), uv(loop.size(), no_index);
        add_polygon(mesh, vertex, uv, 0, static_cast<std::uint32_t>(mesh.faces.size()),
                    mesh.face_line.empty() ? 0 : mesh.face_line.back());
        closed.push_back(loop);
    }
    if (!closed.empty()) said.notes.push_back(fmt::format("{}: closed", holes_text(closed)));
}

}  // namespace unravel::sim
